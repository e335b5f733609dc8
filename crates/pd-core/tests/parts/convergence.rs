//! Convergence studies: the series of spacings and horizons, and the observed order.
use pd_core::Error;
use pd_core::convergence::{
    Measured, Study, delta_convergence, delta_m_convergence, m_convergence,
};

#[test]
fn the_three_series() {
    let m = m_convergence(0.012, &[2.0, 3.0, 4.0]).expect("series");
    assert!(m.iter().all(|r| (r.horizon() - 0.012).abs() < 1e-15), "δ stays");
    assert!((m[2].spacing - 0.003).abs() < 1e-15);
    let delta = delta_convergence(3.0, &[0.1, 0.05]).expect("series");
    assert!(delta.iter().all(|r| r.ratio == 3.0) && delta[1].horizon() < delta[0].horizon());
    // δ ~ m^−2: halved where m grows by √2.
    let both = delta_m_convergence(0.1, &[2.0, 8_f64.sqrt()], 2.0).expect("series");
    assert!((both[1].horizon() - 0.05).abs() < 1e-15, "{both:?}");
    assert!(delta_convergence(3.0, &[0.1, 0.0]).is_err());
    assert!(m_convergence(f64::NAN, &[3.0]).is_err());
}

#[test]
fn the_order_of_a_known_error() {
    let members = delta_convergence(3.0, &[0.4, 0.2, 0.05]).expect("series");
    let error = |h: f64| 7.0 * h.powf(1.5);
    let study = Study::run(&members, |r| {
        Ok::<_, Error>(Measured { error: error(r.spacing), nodes: (1.0 / r.spacing) as usize })
    });
    let study = study.expect("study");
    assert_eq!(study.rows[0].order, None);
    for row in &study.rows[1..] {
        assert!((row.order.expect("order") - 1.5).abs() < 1e-12);
    }
    assert!((study.order().expect("order") - 1.5).abs() < 1e-12);
    assert!(study.to_string().lines().count() == 4 && study.to_string().contains("1.50"));
}

#[test]
fn an_error_of_zero_has_no_order_and_failures_pass_through() {
    let members = delta_convergence(3.0, &[0.4, 0.2]).expect("series");
    let study = Study::run(&members, |_| Ok::<_, Error>(Measured { error: 0.0, nodes: 1 }));
    assert_eq!(study.expect("study").order(), None);
    assert_eq!(Study::run(&members, |_| Err("no body")).expect_err("passed on"), "no body");
}
