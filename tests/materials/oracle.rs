//! Forces, energies and node fields of every model against independent brute-force codes, on
//! small bodies with a missing row of nodes and a pre-crack: lattice and cloud, f64 and f32.

use nalgebra::{Matrix3, Matrix6, SMatrix};
use pd_core::crack::CrackSurface;
use pd_testkit::oracle::{Case, flat, relative_difference};
use peridynamics::models::correspondence::unpacked;
use peridynamics::prelude::*;

/// Checks forces and energy of one material on lattice and cloud.
fn check<T, const D: usize, M>(
    case: &Case,
    group: &str,
    crack: &(impl CrackSurface<D> + Clone + 'static),
    material: impl Fn() -> M,
    extra: impl Fn(&str, &dyn Fn(usize) -> (M::NodeConst, M::FamilyConst, M::NodeState)),
) where
    T: Real,
    M: StrainEnergy<T, D>,
{
    let policy = || {
        let policy = Precracked::by(crack.clone());
        if group.ends_with("m_intact") { policy } else { policy.leaving_family() }
    };
    let tolerance = if T::NAME == "f64" { 1e-12 } else { 1e-4 };
    let compare = |what: &str, got: &[f64], field: &str| {
        let difference = relative_difference(got, &case.result(group, field));
        assert!(difference < tolerance, "{group} {what} {field} {}: {difference:e}", T::NAME);
    };
    fn fill<T: Real, const D: usize, F: Family<T, D>, M: StrainEnergy<T, D>>(
        case: &Case,
        group: &str,
        body: &mut Body<T, D, F, M, Precracked<D>>,
    ) -> (Vec<f64>, Vec<f64>, f64) {
        for (node, u) in case.displacement::<D>(group).iter().enumerate() {
            body.set_displacement_of(node, u);
        }
        body.evaluate().expect("evaluates");
        let forces = (0..body.nodes())
            .flat_map(|i| body.force_density(i).iter().copied().collect::<Vec<_>>())
            .collect();
        (forces, body.energy_densities(), body.strain_energy() * case.thickness())
    }
    let quadrature = case.quadrature();
    let cloud = Cloud::<T, D>::new(&case.points(), case.horizon(), quadrature).expect("family");
    let mut body = Body::new(cloud, material(), policy()).expect("body");
    let (f, w, e) = fill(case, group, &mut body);
    compare("cloud", &f, "force_density");
    compare("cloud", &w, "energy_density");
    compare("cloud", &[e], "total_energy");
    extra("cloud", &|i| (body.constants(i), body.family_constants(i), body.state(i)));
    if let Some(grid) = case.grid::<D>() {
        let lattice = Lattice::<T, D>::new(&grid, case.horizon(), quadrature).expect("family");
        let mut body = Body::new(lattice, material(), policy()).expect("body");
        let (f, w, e) = fill(case, group, &mut body);
        compare("lattice", &f, "force_density");
        compare("lattice", &w, "energy_density");
        compare("lattice", &[e], "total_energy");
        extra("lattice", &|i| (body.constants(i), body.family_constants(i), body.state(i)));
    }
}

fn isotropic(case: &Case) -> Isotropic {
    Isotropic::from_young_poisson(case.number("E"), case.number("nu")).expect("moduli")
}

fn mode(case: &Case) -> PlaneMode {
    match case.json["mode"].as_str() {
        Some("plane_stress") => PlaneMode::PlaneStress,
        _ => PlaneMode::PlaneStrain,
    }
}

/// Both kinematics, both precisions, every group of results.
macro_rules! ordinary {
    ($case:expr, $d:literal, $crack:ident, $model:expr) => {{
        let case = $case;
        let crack = case.$crack();
        assert_eq!(case.misjudged_bonds::<$d>(&crack), 0);
        let groups = case.json["results"].as_object().expect("groups");
        for group in groups.keys() {
            let model = || $model(&case);
            if group.starts_with("linear") {
                let m = || Ordinary::linearised(model());
                check::<f64, $d, _>(&case, group, &crack, m, |_, _| ());
                check::<f32, $d, _>(&case, group, &crack, m, |_, _| ());
            } else {
                let m = || Ordinary::new(model());
                check::<f64, $d, _>(&case, group, &crack, m, |_, _| ());
                check::<f32, $d, _>(&case, group, &crack, m, |_, _| ());
            }
        }
    }};
}

const RHO: f64 = 1000.0;

#[test]
fn pmb_in_the_plane() {
    for name in ["pmb_ps_unit_one", "pmb_ps_unit_exact", "pmb_pe_conical_one"] {
        ordinary!(Case::read(name), 2, segment, |c: &Case| {
            Pmb::plane(&isotropic(c), mode(c), RHO, c.influence()).expect("material")
        });
    }
}

#[test]
fn pmb_solid() {
    ordinary!(Case::read("pmb_3d_unit_one"), 3, polygon, |c: &Case| {
        Pmb::solid(&isotropic(c), RHO, c.influence()).expect("material")
    });
}

#[test]
fn linear_solid_in_the_plane() {
    for name in ["lps_ps_unit_one", "lps_ps_gauss_exact", "lps_pe_gauss_one"] {
        ordinary!(Case::read(name), 2, segment, |c: &Case| {
            LinearSolid::plane(&isotropic(c), mode(c), RHO, c.influence()).expect("material")
        });
    }
}

#[test]
fn linear_solid() {
    ordinary!(Case::read("lps_3d_unit_one"), 3, polygon, |c: &Case| {
        LinearSolid::solid(&isotropic(c), RHO, c.influence()).expect("material")
    });
}

#[test]
fn madenci_oterkus() {
    // The reference for large displacements has the printed Λ (errata 001-3): see below.
    let case = Case::read("mo_ps");
    let crack = case.segment();
    let material = || {
        let model = MadenciOterkus::plane(&isotropic(&case), mode(&case), RHO);
        Ordinary::linearised(model.expect("material"))
    };
    check::<f64, 2, _>(&case, "linear_small", &crack, material, |_, _| ());
    check::<f32, 2, _>(&case, "linear_small", &crack, material, |_, _| ());
}

#[test]
fn madenci_oterkus_as_printed() {
    let case = Case::read("mo_ps");
    let crack = case.segment();
    let material = || {
        let model = MadenciOterkus::plane(&isotropic(&case), mode(&case), RHO);
        model.expect("material").as_printed()
    };
    check::<f64, 2, _>(&case, "nonlinear_large", &crack, material, |what, node| {
        // The state is 2aθ, and a is given.
        let a = 2.0 * case.result("nonlinear_large", "a")[0];
        let theta: Vec<f64> = (0..case.positions::<2>().len()).map(|i| node(i).2 / a).collect();
        let difference = relative_difference(&theta, &case.result("nonlinear_large", "theta"));
        assert!(difference < 1e-12, "{what} θ: {difference:e}");
    });
    check::<f32, 2, _>(&case, "nonlinear_large", &crack, material, |_, _| ());
}

fn stiffness2(case: &Case) -> Stiffness<2> {
    let c = Matrix3::from_row_slice(&flat(&case.json["C_voigt"]));
    Stiffness::<2>::from_voigt(c).expect("stiffness")
}

fn stiffness3(case: &Case) -> Stiffness<3> {
    let c = Matrix6::from_row_slice(&flat(&case.json["C_voigt"]));
    Stiffness::<3>::from_voigt(c).expect("stiffness")
}

#[test]
fn polynomial_micromoduli() {
    for name in ["osb_aniso_2d_composite20_one", "osb_aniso_2d_glassepoxy40_exact"] {
        ordinary!(Case::read(name), 2, segment, |c: &Case| {
            PolynomialMicromoduli::plane(&stiffness2(c), RHO, c.influence()).expect("material")
        });
    }
    ordinary!(Case::read("osb_aniso_3d_composite20_one"), 3, polygon, |c: &Case| {
        PolynomialMicromoduli::solid(&stiffness3(c), RHO, c.influence()).expect("material")
    });
}

#[test]
fn positive_split() {
    ordinary!(Case::read("osb_positive_2d_composite20_one"), 2, segment, |c: &Case| {
        PositiveSplit::plane(&stiffness2(c), RHO, c.influence()).expect("material")
    });
    ordinary!(Case::read("osb_positive_3d_composite20_one"), 3, polygon, |c: &Case| {
        PositiveSplit::solid(&stiffness3(c), RHO, c.influence()).expect("material")
    });
}

/// Entries of a matrix, row by row.
fn rows<T: Real, const D: usize>(m: &SMatrix<T, D, D>) -> Vec<f64> {
    m.transpose().iter().map(|x| x.to_f64()).collect()
}

/// F, stress and shape tensor of a correspondence material.
fn correspondence<T, const D: usize, L>(
    case: &Case,
    group: &str,
    crack: &(impl CrackSurface<D> + Clone + 'static),
    law: &L,
) where
    T: Real,
    L: peridynamics::models::Hyperelastic<T, D> + Clone,
{
    let tolerance = if T::NAME == "f64" { 1e-12 } else { 1e-4 };
    let material = || Correspondence::new(law.clone(), RHO, case.influence()).expect("material");
    check::<T, D, _>(case, group, crack, material, |what, node| {
        let count = case.positions::<D>().len();
        // B is in Δx^-(D+2).
        let unit = case.number("dx").powi(D as i32 + 2) * case.thickness();
        let mut fields: Vec<(&str, Vec<f64>)> =
            vec![("F", vec![]), ("stress", vec![]), ("B", vec![]), ("first_pk", vec![])];
        for i in 0..count {
            let ((), (b, _), (_, (h, _))) = node(i);
            let f = h + SMatrix::identity();
            fields[0].1.extend(rows(&f));
            fields[1].1.extend(rows(&law.cauchy(&h)));
            fields[2].1.extend(rows(&unpacked(&b)).iter().map(|x| x / unit));
            fields[3].1.extend(rows(&law.stress(&h)));
        }
        for (field, got) in fields {
            let reference = case.result(group, field);
            if !reference.is_empty() {
                let difference = relative_difference(&got, &reference);
                assert!(difference < tolerance, "{what} {field} {}: {difference:e}", T::NAME);
            }
        }
    });
}

#[test]
fn correspondence_small_strain() {
    for name in ["nosb_2d_hattori30_linear_one", "nosb_2d_random_linear_irregular"] {
        let case = Case::read(name);
        let crack = case.segment();
        assert_eq!(case.misjudged_bonds(&crack), 0);
        let law = LinearElastic(stiffness2(&case));
        correspondence::<f64, 2, _>(&case, "linear_small", &crack, &law);
        correspondence::<f32, 2, _>(&case, "linear_small", &crack, &law);
    }
    let case = Case::read("nosb_3d_random_linear_one");
    let law = LinearElastic(stiffness3(&case));
    correspondence::<f64, 3, _>(&case, "linear_small", &case.polygon(), &law);
    correspondence::<f32, 3, _>(&case, "linear_small", &case.polygon(), &law);
}

#[test]
fn correspondence_finite_strain() {
    let case = Case::read("nosb_svk_3d_iso_linear_one");
    let law = SaintVenantKirchhoff(stiffness3(&case));
    correspondence::<f64, 3, _>(&case, "finite_large", &case.polygon(), &law);
    correspondence::<f32, 3, _>(&case, "finite_large", &case.polygon(), &law);
}

#[test]
fn two_materials_in_one_body() {
    let case = Case::read("nosb_2d_bimaterial_linear_one");
    let all = flat(&case.json["C_voigt_per_node"]);
    let stiffness = |node: usize| Matrix3::from_row_slice(&all[9 * node..9 * node + 9]);
    let last = all.len() / 9 - 1;
    let region = (0..=last).map(|i| u8::from(stiffness(i) != stiffness(0))).collect::<Vec<_>>();
    let make = |node: usize| {
        let law = LinearElastic(Stiffness::<2>::from_voigt(stiffness(node)).expect("stiffness"));
        Correspondence::new(law, RHO, case.influence()).expect("material")
    };
    let material = || Regions::new([make(0), make(last)], region.clone()).expect("regions");
    let crack = case.segment();
    check::<f64, 2, _>(&case, "linear_small", &crack, material, |_, _| ());
    check::<f32, 2, _>(&case, "linear_small", &crack, material, |_, _| ());
}

/// Dilatation and m of linear solids, in every group of results.
fn fields_of_linear_solid<T: Real, const D: usize>(
    case: &Case,
    crack: &(impl CrackSurface<D> + Clone + 'static),
    model: impl Fn() -> LinearSolid,
) {
    let tolerance = if T::NAME == "f64" { 1e-12 } else { 1e-4 };
    for group in case.json["results"].as_object().expect("groups").keys() {
        let n = case.positions::<D>().len();
        let unit = case.number("dx").powi(D as i32 + 2) * case.thickness();
        // The reference's θ is c_θ/D of the trace.
        let to_trace = D as f64 / case.result(group, "c_theta")[0];
        let compare = |what: &str, node: &dyn Fn(usize) -> (T, (), T)| {
            let theta: Vec<f64> =
                (0..n).map(node).map(|(c, (), s)| model().dilatation(c, s).to_f64()).collect();
            let m: Vec<f64> = (0..n).map(|i| unit / node(i).0.to_f64()).collect();
            let reference =
                case.result(group, "theta").iter().map(|t| t * to_trace).collect::<Vec<_>>();
            for (field, difference) in [
                ("theta", relative_difference(&theta, &reference)),
                ("m", relative_difference(&m, &case.result(group, "m"))),
            ] {
                assert!(difference < tolerance, "{group} {what} {field}: {difference:e}");
            }
        };
        if group.starts_with("linear") {
            check::<T, D, _>(case, group, crack, || Ordinary::linearised(model()), compare);
        } else {
            check::<T, D, _>(case, group, crack, || Ordinary::new(model()), compare);
        }
    }
}

#[test]
fn node_fields_of_linear_solids() {
    for name in ["lps_ps_unit_one", "lps_ps_gauss_exact", "lps_pe_gauss_one"] {
        let case = Case::read(name);
        let model = || {
            let model = LinearSolid::plane(&isotropic(&case), mode(&case), RHO, case.influence());
            model.expect("material")
        };
        fields_of_linear_solid::<f64, 2>(&case, &case.segment(), model);
        fields_of_linear_solid::<f32, 2>(&case, &case.segment(), model);
    }
    let case = Case::read("lps_3d_unit_one");
    let model = || LinearSolid::solid(&isotropic(&case), RHO, case.influence()).expect("material");
    fields_of_linear_solid::<f64, 3>(&case, &case.polygon(), model);
    fields_of_linear_solid::<f32, 3>(&case, &case.polygon(), model);
}

/// k₀/m of the positive split.
#[test]
fn node_fields_of_the_positive_split() {
    fn compare<T: Real, const D: usize>(case: &Case, what: &str, ratio: &dyn Fn(usize) -> T) {
        let tolerance = if T::NAME == "f64" { 1e-12 } else { 1e-4 };
        let n = case.positions::<D>().len();
        let unit = case.number("dx").powi(D as i32 + 2) * case.thickness();
        let m = case.result("linear_small", "m");
        let k0: Vec<f64> = (0..n).map(|i| ratio(i).to_f64() * m[i] / unit).collect();
        let difference = relative_difference(&k0, &case.result("linear_small", "k0"));
        assert!(difference < tolerance, "{what} {}: {difference:e}", T::NAME);
    }
    macro_rules! compare {
        ($name:literal, $d:literal, $crack:ident, $model:expr) => {{
            let case = Case::read($name);
            let material = || Ordinary::linearised($model(&case).expect("material"));
            check::<f64, $d, _>(&case, "linear_small", &case.$crack(), material, |what, node| {
                compare::<f64, $d>(&case, what, &|i| node(i).0);
            });
            check::<f32, $d, _>(&case, "linear_small", &case.$crack(), material, |what, node| {
                compare::<f32, $d>(&case, what, &|i| node(i).0);
            });
        }};
    }
    compare!("osb_positive_2d_composite20_one", 2, segment, |c: &Case| {
        PositiveSplit::plane(&stiffness2(c), RHO, c.influence())
    });
    compare!("osb_positive_3d_composite20_one", 3, polygon, |c: &Case| {
        PositiveSplit::solid(&stiffness3(c), RHO, c.influence())
    });
}
