//! The compiler's message that the documentation shows is the one that the trait gives. (That the
//! program it is about does not compile is the doctest beside it.)

/// The text of `key = "…"` with its line breaks joined as the compiler joins them.
fn text_of(source: &str, key: &str) -> String {
    let start = source.find(&format!("{key} = \"")).expect(key) + key.len() + 4;
    let text: &str = &source[start..start + source[start..].find('"').expect("closed")];
    text.split("\\\n").map(str::trim_start).collect()
}

#[test]
fn what_does_not_fit_is_shown() {
    let traits = include_str!("../../crates/pd-core/src/material.rs");
    let before = traits.split("pub trait StressState").next().expect("trait");
    let attribute = &before[before.rfind("on_unimplemented").expect("attribute")..];
    let shown = include_str!("../../src/lib.rs");
    let message = text_of(attribute, "message").replace("{Self}", "Ordinary<Pmb>");
    assert!(message.contains("no stress"), "{message}");
    for line in [
        format!("//! error[E0277]: {message}\n"),
        format!("^^^^ {}\n", text_of(attribute, "label")),
        format!("//!   = note: {}\n", text_of(attribute, "note")),
    ] {
        assert!(shown.contains(&line), "not in src/lib.rs: {line}");
    }
}
