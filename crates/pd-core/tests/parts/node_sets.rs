//! Node sets are sorted, unique and within the body; names that are wrong say which are right.

use pd_core::grid::NodeSets;
use pd_core::region::Cuboid;
use pd_core::{Error, Grid, NodeSet};
use proptest::prelude::*;
use std::collections::BTreeSet;

fn set(nodes: &[usize]) -> NodeSet {
    NodeSet::from_nodes(nodes.iter().copied(), 100).unwrap()
}

#[test]
fn sorted_and_unique() {
    let nodes = set(&[7, 3, 99, 3, 0]);
    assert_eq!(nodes.iter().collect::<Vec<_>>(), [0, 3, 7, 99]);
    assert_eq!((nodes.len(), nodes.contains(7), nodes.contains(8)), (4, true, false));
    assert!(!nodes.contains(7 + (1 << 32)));
}

#[test]
fn refuses_nodes_that_are_not_there() {
    let refused = |nodes: &[usize]| match NodeSet::from_nodes(nodes.iter().copied(), 100) {
        Err(Error::InvalidValue { what: "node index", value, .. }) => value,
        other => panic!("{other:?}"),
    };
    assert_eq!(refused(&[1, 100, 200]), 100.0);
    assert_eq!(refused(&[1 << 32]), 4294967296.0);
    // more nodes than 32 bits can number
    assert!(NodeSet::from_nodes([1 << 32], 1 << 40).is_err());
}

proptest! {
    #[test]
    fn algebra(
        a in prop::collection::vec(0..100usize, 0..30),
        b in prop::collection::vec(0..100usize, 0..30),
    ) {
        let model = |nodes: &[usize]| nodes.iter().copied().collect::<BTreeSet<_>>();
        let (x, y) = (model(&a), model(&b));
        let (a, b) = (set(&a), set(&b));
        prop_assert!(a.union(&b).iter().eq(x.union(&y).copied()));
        prop_assert!(a.minus(&b).iter().eq(x.difference(&y).copied()));
    }
}

#[test]
fn selection_by_place() {
    let plate = Cuboid::new([0.0, 0.0], [4.0, 3.0]).unwrap();
    let grid = Grid::new(&plate, 1.0).unwrap();
    let left = grid.select(|x| x.x < 1.0);
    assert_eq!(left.iter().collect::<Vec<_>>(), [0, 4, 8]);
    let strip = Cuboid::new([0.0, 0.0], [4.0, 1.0]).unwrap();
    assert_eq!(grid.select_in(&strip).iter().collect::<Vec<_>>(), [0, 1, 2, 3]);
}

#[test]
fn empty_sets_are_refused_by_name() {
    assert_eq!(set(&[4]).non_empty("left grip"), Ok(set(&[4])));
    let error = NodeSet::default().non_empty("left grip").unwrap_err();
    assert_eq!(error, Error::EmptySet { name: "left grip".into() });
    assert!(error.to_string().starts_with("node set 'left grip' has no nodes"), "{error}");
    let named = NodeSets::new().insert("left grip", NodeSet::default()).unwrap_err();
    assert_eq!(named, error);
}

#[test]
fn unknown_names_list_the_known() {
    let mut sets = NodeSets::new();
    sets.insert("top", set(&[1])).unwrap();
    sets.insert("bottom", set(&[2])).unwrap();
    sets.insert("top", set(&[3])).unwrap();
    assert_eq!(sets.get("top"), Ok(&set(&[3])));
    let message = sets.get("tpo").unwrap_err().to_string();
    assert_eq!(message, r#"there is no node set 'tpo'; there are ["bottom", "top"]"#);
}
