//! Checkpoint files are whole or refused: cut short, changed, foreign, of another version; a full
//! disk leaves the one before.
use super::common;
use pd_io::{Error, checkpoint};
use std::path::Path;

const STATE: &[u8] = b"all that changes during a run";

fn write(path: &Path, state: &'static [u8]) -> pd_io::Result<()> {
    checkpoint::write(path, &|out| out.write_all(state))
}

fn reason(path: &Path) -> String {
    let error = checkpoint::read(path).expect_err("refused");
    assert!(matches!(error, Error::Unfit { .. }), "{error:?}");
    assert!(error.to_string().contains(&path.display().to_string()), "{error}");
    error.to_string()
}

#[test]
fn read_as_written() {
    let path = common::folder("checkpoint_read").join("run.state");
    write(&path, STATE).expect("written");
    assert_eq!(checkpoint::read(&path).expect("read"), STATE);
    write(&path, b"").expect("written");
    assert_eq!(checkpoint::read(&path).expect("read"), b"");
}

#[test]
fn cut_short_or_changed_anywhere() {
    let path = common::folder("checkpoint_cut").join("run.state");
    write(&path, STATE).expect("written");
    let whole = std::fs::read(&path).expect("bytes");
    for length in 0..whole.len() {
        std::fs::write(&path, &whole[..length]).expect("cut");
        let reason = reason(&path);
        assert!(reason.contains("cut short") || length < 8, "{length}: {reason}");
    }
    for at in 0..whole.len() {
        for bit in 0..8 {
            let mut changed = whole.clone();
            changed[at] ^= 1 << bit;
            std::fs::write(&path, &changed).expect("changed");
            reason(&path);
        }
    }
    let longer = [&whole[..], b"more"].concat();
    std::fs::write(&path, longer).expect("longer");
    reason(&path);
}

#[test]
fn foreign_or_of_another_version() {
    let path = common::folder("checkpoint_foreign").join("run.state");
    std::fs::write(&path, "<?xml version=\"1.0\"?>\n<VTKFile/>").expect("foreign");
    assert!(reason(&path).contains("is not a checkpoint"));
    write(&path, STATE).expect("written");
    let mut newer = std::fs::read(&path).expect("bytes");
    newer[8] = 7;
    std::fs::write(&path, newer).expect("newer");
    assert!(reason(&path).contains("is of version 7, this program reads version 1"));
    let missing = checkpoint::read(path.with_extension("none")).expect_err("missing");
    assert!(matches!(missing, Error::Unreadable { .. }), "{missing:?}");
}

/// What is written goes to a device that is always full.
#[cfg(target_os = "linux")]
#[test]
fn disk_full() {
    let path = common::folder("checkpoint_full").join("run.state");
    write(&path, STATE).expect("written");
    std::os::unix::fs::symlink("/dev/full", path.with_extension("state.part")).expect("link");
    let error = write(&path, b"a later state").expect_err("full");
    assert!(matches!(error, Error::File { .. }), "{error:?}");
    let said = error.to_string();
    assert!(said.contains("No space left") && said.contains("before is intact"), "{said}");
    assert_eq!(checkpoint::read(&path).expect("intact"), STATE);
}
