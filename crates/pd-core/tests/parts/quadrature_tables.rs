//! β of every offset against the tables of an independent code.
use nalgebra::SVector;
use pd_core::Quadrature;
use serde_json::Value;

/// Checks all offsets 0 ≤ ξ₁ ≤ … ≤ ξ_D up to the reach, listed (β > 0 somewhere) or not.
fn check<const D: usize>(m: f64, table: &[Value]) -> usize {
    let (dx, edges) = (1.3e-3, SVector::<f64, D>::repeat(1.3e-3));
    let side = m as usize + 3;
    let mut found = 0;
    for code in 1..side.pow(D as u32) {
        let offset: [usize; D] = std::array::from_fn(|k| code / side.pow(k as u32) % side);
        if !offset.is_sorted() {
            continue;
        }
        let row = table.iter().find(|row| {
            row[0].as_array().unwrap().iter().zip(offset).all(|(a, b)| a.as_u64() == Some(b as u64))
        });
        found += usize::from(row.is_some());
        let xi = SVector::from(offset.map(|n| n as f64 * dx));
        let algorithms =
            [Quadrature::None, Quadrature::LinearRamp, Quadrature::ExtendedRamp, Quadrature::Exact];
        for (column, quadrature) in algorithms.iter().enumerate() {
            let expected = row.map_or(0.0, |row| row[column + 1].as_f64().unwrap());
            let beta = quadrature.weight(&xi, &edges, m * dx);
            assert!(
                (beta - expected).abs() < 1e-12,
                "{D}D m = {m} {offset:?} {quadrature:?}: {beta} for {expected}"
            );
            assert_eq!(beta == 0.0, expected == 0.0, "{D}D m = {m} {offset:?} {quadrature:?}");
            assert!(beta == 0.0 || xi.norm() <= quadrature.reach(&edges, m * dx) * (1.0 + 1e-9));
        }
    }
    found
}

#[test]
fn all_tables_agree() {
    let file: Value = serde_json::from_str(include_str!("../data/beta_tables.json")).unwrap();
    let tables = file["tables"].as_object().unwrap();
    assert_eq!(tables.len(), 15);
    for (name, table) in tables {
        let table = table.as_array().unwrap();
        let m = name.split('=').next_back().unwrap().parse().unwrap();
        let found =
            if name.starts_with("2D") { check::<2>(m, table) } else { check::<3>(m, table) };
        assert_eq!(found, table.len(), "{name}");
    }
}
