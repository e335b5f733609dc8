//! A study of accuracy against cost: the front, what a turn of a knob is worth, and a file that
//! survives being stopped anywhere.
use peridynamics::trade::{Cost, Error, Point, Record, Study, Trade, Worth};
use std::cell::{Cell, RefCell};
use std::path::PathBuf;
use std::rc::Rc;

type Outcome = Result<Record, Box<dyn std::error::Error>>;

fn file(name: &str) -> PathBuf {
    let path = std::env::temp_dir().join(format!("pd_trade_{name}_{}.csv", std::process::id()));
    let _ = std::fs::remove_file(&path);
    path
}

/// A scene whose error and time are known: h² by three rules over a time n.
struct Scene {
    now: Rc<Cell<f64>>,
    asked: RefCell<Vec<String>>,
}

impl Scene {
    fn new() -> Self {
        Self { now: Rc::new(Cell::new(0.0)), asked: RefCell::new(Vec::new()) }
    }
    fn study(&self, name: &str) -> Study {
        let now = self.now.clone();
        Study::new(name)
            .knob("n", [10.0, 5.0, 20.0])
            .knob("rule, of thumb", ["good", "bad", "lazy", "odd", "broken"])
            .figure("n twice")
            .clock(move || now.get())
            .one_at_a_time()
            .and_then(|study| study.grid(&["n"]))
            .expect("study")
    }
    fn at(&self, point: &Point) -> Outcome {
        self.asked.borrow_mut().push(point.to_string());
        let n = point.number("n")?;
        let (error, time) = match point.name("rule, of thumb")? {
            "good" => (1.0, 1.0),
            "bad" => (2.0, 1.0),
            "lazy" => (1.01, 0.5),
            "odd" => (0.5, 4.0),
            _ => return Err("two lines:\nit is \"broken\", sorry".into()),
        };
        self.now.set(self.now.get() + n * time);
        Ok(Record::new(error / (n * n)).with("n twice", 2.0 * n))
    }
    fn run(&self, path: &PathBuf) -> Trade {
        self.study("scene").run(path, |point| self.at(point)).expect("trade")
    }
}

#[test]
fn the_front_holds_what_nothing_beats() {
    let (scene, path) = (Scene::new(), file("front"));
    let trade = scene.run(&path);
    // Base, n = 5 and 20, four rules; the grid over n adds nothing.
    assert_eq!(trade.rows().len(), 7);
    let front: Vec<String> =
        trade.front(Cost::Time).iter().map(|(row, _)| row.point.to_string()).collect();
    // "lazy" and n = 5 take 5 s alike: the lower error is on the front.
    assert_eq!(
        front,
        [
            "n = 10, rule, of thumb = lazy",
            "n = 10, rule, of thumb = good",
            "n = 20, rule, of thumb = good"
        ]
    );
    let table = trade.front_table(Cost::Time);
    assert_eq!(table.lines().count(), 2 + 3, "{table}");
    let plot = path.with_extension("png");
    trade.plot(Cost::Time, &plot).expect("plot");
    assert!(std::fs::metadata(&plot).expect("plot").len() > 1000);
    std::fs::remove_file(plot).expect("plot");
    std::fs::remove_file(path).expect("file");
}

#[test]
fn words_follow_from_the_figures() {
    let (scene, path) = (Scene::new(), file("words"));
    let trade = scene.run(&path);
    let turns = trade.turns(Cost::Time);
    let worth = |to: &str| {
        let turn = turns.iter().find(|turn| turn.to.to_string() == to).expect("turn");
        (turn.worth(), turn.sensitivity())
    };
    assert_eq!(worth("lazy").0, Worth::Free);
    assert_eq!(worth("bad").0, Worth::Loses);
    let (odd, p) = worth("odd");
    assert_eq!(odd, Worth::Buys);
    assert!((p - 0.5).abs() < 1e-12, "half the error for four times the time: {p}");
    let (finer, p) = worth("20");
    assert!(finer == Worth::Buys && (p - 2.0).abs() < 1e-12, "{p}");
    let (coarser, p) = worth("5");
    assert!(coarser == Worth::Saves && (p - 2.0).abs() < 1e-12, "{p}");
    let words = trade.words(Cost::Time);
    let place = |what: &str| words.find(what).unwrap_or_else(|| panic!("no '{what}' in\n{words}"));
    assert!(place("costs nothing: rule, of thumb from good to lazy") < place("n from 10 to 20"));
    assert!(place("n from 10 to 20") < place("good to odd"), "better buys first");
    place("half the error costs 1.41 times the time");
    place("Refused: rule, of thumb = broken: two lines.");
    let refused = trade.rows().iter().find_map(|row| row.outcome.as_ref().err());
    assert_eq!(refused.expect("a refusal"), "two lines: it is \"broken\", sorry");
    std::fs::remove_file(path).expect("file");
}

/// A finer error than the reference can tell is no better.
#[test]
fn errors_below_the_resolution_are_alike() {
    let (scene, path) = (Scene::new(), file("resolution"));
    let study = scene.study("scene").resolution(0.02);
    let trade = study.run(&path, |point| scene.at(point)).expect("trade");
    let front = trade.front(Cost::Time);
    // n = 5 errs by 0.04, "lazy" by 0.0101: what costs more than that buys nothing.
    let errors: Vec<f64> = front.iter().map(|(_, m)| m.error).collect();
    assert_eq!(errors, [0.0101]);
    let turns = trade.turns(Cost::Time);
    assert!(turns.iter().all(|turn| turn.worth() != Worth::Buys), "{turns:?}");
    std::fs::remove_file(path).expect("file");
}

/// Stopped anywhere, a study goes on to the same outcome and repeats no whole line.
#[test]
fn a_stopped_study_goes_on() {
    let (scene, path) = (Scene::new(), file("stopped"));
    let whole = scene.run(&path);
    assert_eq!(scene.asked.borrow().len(), 7);
    let bytes = std::fs::read(&path).expect("file");
    for kept in (0..=bytes.len()).step_by(3) {
        std::fs::write(&path, &bytes[..kept]).expect("file");
        let lines = bytes[..kept].iter().filter(|&&b| b == b'\n').count().saturating_sub(2);
        let again = Scene::new();
        again.now.set(0.0);
        let trade = again.run(&path);
        assert_eq!(again.asked.borrow().len(), 7 - lines, "{kept} bytes of {}", bytes.len());
        assert_eq!(trade, whole, "{kept} bytes");
        assert_eq!(std::fs::read(&path).expect("file"), bytes, "{kept} bytes");
    }
    std::fs::remove_file(path).expect("file");
}

#[test]
fn a_file_of_another_study_is_refused_and_kept() {
    let (scene, path) = (Scene::new(), file("foreign"));
    scene.run(&path);
    let bytes = std::fs::read(&path).expect("file");
    let refused = |study: Study| {
        let told = study.run(&path, |_| unreachable!("another study's file"));
        assert!(
            matches!(told, Err(Error::File(peridynamics::io::Error::Foreign { .. }))),
            "{told:?}"
        );
        assert_eq!(std::fs::read(&path).expect("file"), bytes);
    };
    refused(scene.study("another scene"));
    refused(scene.study("scene").knob("more", ["yes"]));
    refused(scene.study("scene").figure("more"));
    std::fs::write(&path, [&bytes[..], b"1,2\n"].concat()).expect("file");
    let told = scene.study("scene").run(&path, |_| unreachable!());
    let malformed =
        peridynamics::io::Error::Malformed { path: path.clone(), line: 10, given: 2, wanted: 9 };
    assert_eq!(told.expect_err("a short line").to_string(), malformed.to_string());
    std::fs::remove_file(path).expect("file");
}

#[test]
fn mistakes_are_named() {
    let path = file("mistakes");
    let message = |told: Result<Trade, Error>| told.expect_err("a mistake").to_string();
    let study = || Study::new("s").knob("a", [1.0]).one_at_a_time().expect("study");
    let told = message(study().run(&path, |point| Ok(Record::new(point.number("b")?))));
    assert_eq!(told, "there is no knob 'b' in this study; there are [\"a\"]");
    let told = message(study().run(&path, |point| {
        point.name("a")?;
        Ok(Record::new(1.0))
    }));
    assert_eq!(told, "the knob 'a' is at '1', which is not a name");
    let told = message(study().run(&path, |_| Ok(Record::new(1.0).with("speed", 1.0))));
    assert_eq!(told, "there is no figure 'speed' in this study; there are []");
    let told = message(study().run(&path, |_| Ok(Record::new(f64::NAN))));
    assert_eq!(told, "no point of 's' came to a result: the error is NaN");
    let twice = Study::new("s").knob("a", [1.0, 1.0]).one_at_a_time();
    assert!(matches!(twice, Err(Error::Knob { .. })));
    let none = Study::new("s").knob("a", [1.0]).grid(&["b"]);
    assert!(matches!(none, Err(Error::Unknown { what: "knob", .. })));
    std::fs::remove_file(path).expect("file");
}
