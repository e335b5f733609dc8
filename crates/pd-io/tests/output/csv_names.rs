//! Column names read back by the rules of RFC 4180.
use super::common;

use common::folder;
use pd_io::{Error, History};

/// The records of a file: fields apart by commas, quotes doubled within quotes.
fn records(text: &str) -> Vec<Vec<String>> {
    let (mut all, mut record, mut field, mut quoted) = (vec![], vec![], String::new(), false);
    let mut rest = text.chars().peekable();
    while let Some(c) = rest.next() {
        match c {
            '"' if quoted && rest.peek() == Some(&'"') => field.extend(rest.next()),
            '"' => quoted = !quoted,
            ',' if !quoted => record.push(std::mem::take(&mut field)),
            '\n' if !quoted => {
                record.push(std::mem::take(&mut field));
                all.push(std::mem::take(&mut record));
            }
            c => field.push(c),
        }
    }
    assert!(!quoted && field.is_empty() && record.is_empty(), "the last record is cut");
    all
}

#[test]
fn names_with_commas_quotes_and_lines() {
    let path = folder("csv").join("history.csv");
    let names = ["time [s]", "F_x, F_y [N]", "the \"grip\"", "two\nlines", "cr\rhere", "", "\""];
    let values: Vec<f64> = (0..names.len()).map(|k| k as f64 / 3.0).collect();
    History::create(&path, &names).and_then(|mut table| table.row(&values)).expect("file");
    let read = records(&std::fs::read_to_string(&path).expect("text"));
    assert_eq!(read[0], names);
    let numbers: Vec<f64> = read[1].iter().map(|x| x.parse().expect("number")).collect();
    assert_eq!(numbers, values);
}

#[test]
fn plain_names_stay_plain() {
    let path = folder("csv-plain").join("history.csv");
    History::create(&path, &["time [s]", "force [N]"]).expect("file");
    assert_eq!(std::fs::read_to_string(&path).expect("text"), "time [s],force [N]\n");
    let told = History::create(&path, &[]);
    assert!(matches!(told, Err(Error::Empty { .. })), "{told:?}");
}
