//! Nodes that share a pixel all count, whatever their order.
use super::common;

use common::{Image, folder};
use nalgebra::SVector;
use pd_io::{ColourMap, FieldMap};

/// The map's own pixels start here.
const LEFT: usize = 24;
const TOP: usize = 48;

fn lattice(columns: usize, rows: usize) -> Vec<SVector<f64, 2>> {
    let node = |k: usize| SVector::from([(k % columns) as f64 + 0.5, (k / columns) as f64 + 0.5]);
    (0..columns * rows).map(node).collect()
}

/// Numbers in [0, 1) without a pattern: multiples of the golden ratio.
fn scattered(k: usize) -> f64 {
    (k as f64 * 0.618_033_988_749_894_9).fract()
}

#[test]
fn a_pixel_is_the_mean_of_its_nodes() {
    let place = folder("mean");
    let (columns, rows, per) = (192, 48, 3);
    let values: Vec<f64> = (0..columns * rows).map(scattered).collect();
    for colours in [ColourMap::Viridis, ColourMap::Diverging] {
        let path = place.join("mean.png");
        let map = FieldMap::new(&lattice(columns, rows), 1.0, &values).range(0.0, 1.0);
        map.colours(colours).size(columns / per).write(&path).expect("map");
        let image = Image::read(&path);
        for y in 0..rows / per {
            for x in 0..columns / per {
                let nodes = (0..per * per).map(|k| {
                    let (column, row) = (per * x + k % per, rows - 1 - (per * y + k / per));
                    values[row * columns + column]
                });
                let mean = nodes.sum::<f64>() / (per * per) as f64;
                let (drawn, wanted) = (image.at(LEFT + x, TOP + y), colours.colour(mean));
                // Sums in another order may round the other way.
                let close = drawn.iter().zip(wanted).all(|(a, b)| a.abs_diff(b) <= 1);
                assert!(close, "({x}, {y}): {drawn:?}, not {wanted:?}");
            }
        }
    }
}

#[test]
fn the_order_of_nodes_changes_nothing() {
    let place = folder("order");
    let positions = lattice(900, 90);
    let values: Vec<f64> = (0..positions.len()).map(|k| f64::from(k % 7 == 0)).collect();
    let back = |list: &[SVector<f64, 2>]| list.iter().rev().copied().collect::<Vec<_>>();
    let reversed: Vec<f64> = values.iter().rev().copied().collect();
    for colours in [ColourMap::Damage, ColourMap::Viridis] {
        let draw = |name: &str, positions: &[SVector<f64, 2>], values: &[f64]| {
            let path = place.join(name);
            let map = FieldMap::new(positions, 1.2, values).colours(colours).size(128);
            map.write(&path).expect("map");
            let image = Image::read(&path);
            image.part(0..image.width, 0..image.height)
        };
        let there = draw("there.png", &positions, &values);
        let back = draw("back.png", &back(&positions), &reversed);
        let close = |a: &[u8; 3], b: &[u8; 3]| a.iter().zip(b).all(|(a, b)| a.abs_diff(*b) <= 1);
        assert!(there.iter().zip(&back).all(|(a, b)| close(a, b)), "{colours:?}");
    }
}

#[test]
fn a_crack_one_node_wide_is_red_in_every_row() {
    let place = folder("crack");
    let (columns, rows) = (4000, 400);
    let positions = lattice(columns, rows);
    // Upright, and one that runs across the columns.
    for (name, crack) in [("upright", [1801, 0]), ("oblique", [1200, 3])] {
        let broken = |k: usize| k % columns == crack[0] + crack[1] * (k / columns);
        let damage: Vec<f64> = (0..positions.len()).map(|k| f64::from(broken(k))).collect();
        let path = place.join(format!("{name}.png"));
        let map = FieldMap::new(&positions, 1.0, &damage).colours(ColourMap::Damage);
        map.title(&format!("{name} crack, 4000 x 400")).write(&path).expect("map");
        let image = Image::read(&path);
        let red = ColourMap::Damage.colour(1.0);
        for y in TOP..TOP + 64 {
            let wide = (LEFT..LEFT + 640).filter(|&x| image.at(x, y) == red).count();
            let most = 2 + crack[1] * columns / 640 / 2;
            assert!((1..=most).contains(&wide), "{name}, row {y}: {wide} red pixels");
        }
    }
}

#[test]
fn cells_that_move_apart_by_less_than_a_pixel_leave_no_seam() {
    let place = folder("seams");
    // 64 cells on 640 pixels, 1 % apart: a tenth of a pixel.
    let positions: Vec<_> = lattice(64, 8).iter().map(|p| p * 1.01).collect();
    let path = place.join("seams.png");
    let map = FieldMap::new(&positions, 1.0, &vec![1.0; positions.len()]).range(0.0, 1.0);
    map.write(&path).expect("map");
    let image = Image::read(&path);
    let full = ColourMap::Viridis.colour(1.0);
    assert!(image.part(LEFT..LEFT + 640, TOP..TOP + 80).iter().all(|&c| c == full));
}
