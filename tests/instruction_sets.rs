//! AVX2 and AVX-512 give the same bits, in every scene of the benches. Debug builds have no AVX-512
//! version: `cargo test --release --test instruction_sets -- --ignored`.
#![cfg(not(debug_assertions))]

#[path = "../benches/scenes.rs"]
#[allow(dead_code)]
mod scenes;

use peridynamics::prelude::*;
use std::process::Command;

/// Prints what a step leaves in every scene, as one number each.
struct Bits;

impl scenes::Visit for Bits {
    fn scene<T, const D: usize, F, M, P>(
        &mut self,
        name: &str,
        _: f64,
        body: impl FnOnce() -> Result<Body<T, D, F, M, P>>,
    ) where
        T: Real,
        F: Family<T, D>,
        M: Material<T, D>,
        P: DamagePolicy<T, D, M>,
    {
        let mut body = body().expect("body");
        scenes::wave(&mut body);
        body.evaluate_and_break(1, &mut ()).expect("step");
        let hash = body.force().as_slice().iter().fold(0_u64, |hash, x| {
            (hash.rotate_left(5) ^ x.to_f64().to_bits()).wrapping_mul(0x9e37_79b9_7f4a_7c15)
        });
        println!("bits {name}, {}: {hash:016x}", T::NAME);
    }
}

#[test]
#[ignore = "what the other test runs"]
fn print_bits() {
    scenes::all::<f64>([21, 11], &mut Bits);
    scenes::all::<f32>([21, 11], &mut Bits);
}

/// The processor that valgrind stands for has AVX2 and FMA, no AVX-512: the same program takes its
/// other version there.
#[cfg(target_arch = "x86_64")]
#[test]
#[ignore = "needs valgrind and a processor with AVX-512"]
fn avx2_and_avx512_give_the_same_bits() {
    assert!(is_x86_feature_detected!("avx512vl"), "a processor with AVX-512");
    let program = std::env::current_exe().expect("this program");
    let bits = |mut command: Command| -> Vec<String> {
        command.args(["--ignored", "--exact", "print_bits", "--nocapture", "--test-threads=1"]);
        let output = command.output().expect("valgrind is installed");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let text = String::from_utf8_lossy(&output.stdout);
        text.lines().filter_map(|l| l.rsplit_once("bits ")).map(|l| l.1.to_owned()).collect()
    };
    let wide = bits(Command::new(&program));
    let mut narrow = Command::new("valgrind");
    narrow.args(["--tool=none", "--quiet"]).arg(&program);
    let narrow = bits(narrow);
    assert!(wide.len() >= 2 * 17, "{} scenes", wide.len());
    assert_eq!(wide, narrow);
}

/// A body whose bonds break by their energy, which is a pass of its own.
fn by_energy<F: Family<f64, 3>>(family: F) {
    let moduli = Isotropic::from_young_poisson(1e9, 0.25).expect("moduli");
    let model = LinearSolid::solid(&moduli, scenes::RHO, InfluenceFunction::Constant);
    let critical = BondEnergy::new(1.0).expect("critical energy");
    let material = Ordinary::new(model.expect("model"));
    let mut body = Body::new(family, material, Breaking::new(critical)).expect("body");
    body.evaluate_and_break(1, &mut ()).expect("step");
}

/// Arithmetic that is compiled apart from its loop lacks the loop's instructions: a fused multiply-add
/// is then a call, which took seven times as long. No such call is linked.
#[test]
#[ignore = "needs nm"]
fn no_fused_multiply_add_is_a_call() {
    by_energy(scenes::lattice::<f64, 3>(&scenes::grid(11)));
    by_energy(scenes::cloud::<f64, 3>(&scenes::grid(11)));
    let output = Command::new("nm").arg(std::env::current_exe().expect("this program")).output();
    let symbols = String::from_utf8(output.expect("nm is installed").stdout).expect("text");
    let linked = |name: &str| symbols.lines().any(|line| line.split(' ').next_back() == Some(name));
    assert!(symbols.lines().count() > 1000, "{} symbols", symbols.lines().count());
    assert!(!linked("fma") && !linked("fmaf"));
}
