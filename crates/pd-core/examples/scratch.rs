use nalgebra::{SVector,SMatrix,Vector3};
use pd_core::bond::*; use pd_core::body::*; use pd_core::damage::*; use pd_core::family::*; use pd_core::grid::*; use pd_core::lattice::*; use pd_core::material::*; use pd_core::quadrature::*; use pd_core::*;
#[derive(Clone,Copy)] struct Pmb;
impl<T: Real> Material<T,3> for Pmb { type BondConst=(T,T); type NodeConst=(); type FamilySum=(); type NodeState=();
 fn density(&self,_:usize)->f64{1.0}
 fn bond_const(&self, xi:&SVector<f64,3>, s:Scale)->(T,T){ (T::of(xi.norm()), T::of(9.0/3.14/s.horizon.powi(4)/xi.norm())) }
 #[inline(always)] fn force_state(&self,b:&Bond<T,3>,e:End<'_,T,(T,T),(),()>)->SVector<T,3>{ let (ex,m)=b.extension_and_direction(e.bond.0); m*(ex*e.bond.1) }
 #[inline(always)] fn pair_force(&self,b:&Bond<T,3>,e:[End<'_,T,(T,T),(),()>;2])->SVector<T,3>{ let (ex,m)=b.extension_and_direction(e[0].bond.0); m*(ex*e[0].bond.1*(e[0].volume+e[1].volume)) }
}
#[derive(Clone,Copy)] struct Lps;
impl<T: Real> Material<T,3> for Lps { type BondConst=(T,T); type NodeConst=T; type FamilySum=T; type NodeState=T;
 fn density(&self,_:usize)->f64{1.0}
 fn bond_const(&self, xi:&SVector<f64,3>, _:Scale)->(T,T){ (T::of(xi.norm()), T::of(1.0)) }
 fn node_const(&self, f:&Neighbourhood<'_,(T,T),3>)->Result<T>{ Ok(T::of(1.0/f.sum(|m| m.xi.norm_squared()))) }
 #[inline(always)] fn add_bond(&self, s:&mut T, b:&Bond<T,3>, e:End<'_,T,(T,T),T,()>){ *s += e.bond.0*b.extension(e.bond.0)*e.volume; }
 #[inline(always)] fn node_state(&self,s:&T,c:&T,_:&T)->T{ *s**c**c }
 #[inline(always)] fn force_state(&self,b:&Bond<T,3>,e:End<'_,T,(T,T),T,T>)->SVector<T,3>{ let (ex,m)=b.extension_and_direction(e.bond.0); m*(*e.state*e.bond.0+ex*e.bond.1**e.node) }
 #[inline(always)] fn pair_force(&self,b:&Bond<T,3>,e:[End<'_,T,(T,T),T,T>;2])->SVector<T,3>{ let (ex,m)=b.extension_and_direction(e[0].bond.0); 
   let t=|e:&End<'_,T,(T,T),T,T>| (*e.state*e.bond.0+ex*e.bond.1**e.node)*e.volume; m*(t(&e[0])+t(&e[1])) }
}
#[derive(Clone,Copy)] struct Nosb;
impl<T: Real> Material<T,3> for Nosb { type BondConst=T; type NodeConst=SMatrix<T,3,3>; type FamilySum=SMatrix<T,3,3>; type NodeState=(SMatrix<T,3,3>,SMatrix<T,3,3>);
 fn density(&self,_:usize)->f64{1.0}
 fn bond_const(&self, _xi:&SVector<f64,3>, _:Scale)->T{ T::of(1.0) }
 fn node_const(&self, f:&Neighbourhood<'_,T,3>)->Result<SMatrix<T,3,3>>{ let mut k=SMatrix::<f64,3,3>::zeros(); for m in f.members {k+=m.xi*m.xi.transpose();} Ok(k.try_inverse().unwrap().map(T::of)) }
 #[inline(always)] fn add_bond(&self, s:&mut SMatrix<T,3,3>, b:&Bond<T,3>, e:End<'_,T,T,SMatrix<T,3,3>,()>){ let w=*e.bond*e.volume; for j in 0..3 { for i in 0..3 { s[(i,j)] += b.eta[i]*(w*b.xi[j]); } } }
 #[inline(always)] fn node_state(&self,s:&SMatrix<T,3,3>,c:&SMatrix<T,3,3>,_:&(SMatrix<T,3,3>,SMatrix<T,3,3>))->(SMatrix<T,3,3>,SMatrix<T,3,3>){ let h=s*c; let eps=(h+h.transpose())*T::of(0.5); let p=eps*T::of(0.8)+SMatrix::identity()*(h.trace()*T::of(0.7)); (p*c,h) }
 #[inline(always)] fn force_state(&self,b:&Bond<T,3>,e:End<'_,T,T,SMatrix<T,3,3>,(SMatrix<T,3,3>,SMatrix<T,3,3>)>)->SVector<T,3>{ let p=&e.state.0; let w=*e.bond; SVector::from_fn(|i,_| w*(p[(i,0)]*b.xi[0]+p[(i,1)]*b.xi[1]+p[(i,2)]*b.xi[2])) }
 #[inline(always)] fn pair_force(&self,b:&Bond<T,3>,e:[End<'_,T,T,SMatrix<T,3,3>,(SMatrix<T,3,3>,SMatrix<T,3,3>)>;2])->SVector<T,3>{ let (p,q)=(&e[0].state.0,&e[1].state.0); let (w,x)=(*e[0].bond*e[0].volume,*e[1].bond*e[1].volume); SVector::from_fn(|i,_| { let f=|j:usize| (p[(i,j)]*w+q[(i,j)]*x)*b.xi[j]; f(0)+f(1)+f(2)}) }
}
struct Stretch; impl<T:Real,const D:usize,M:Material<T,D,BondConst=(T,T)>> DamageCriterion<T,D,M> for Stretch { type NodeConst=(); type NodeValue=();
 #[inline(always)] fn index(&self,b:&TestedBond<'_,T,D,M,(),()>)->T{ b.bond.extension(b.ends[0].bond.0)/b.ends[0].bond.0*T::of(10.0) } }
fn time<T:Real,M:Material<T,3>,P:DamagePolicy<T,3,M>>(name:&str, m:M, p:P){
  let n=64; let grid=Grid::<3>::lattice(Vector3::zeros(), Vector3::repeat(1.0), [n,n,n]);
  let fam=Lattice::<T,3>::new(&grid, Horizon::Cells(3.015), Quadrature::None).unwrap();
  let bonds=2*Family::<T,3>::bonds(&fam);
  let mut b=Body::new(fam,m,p).unwrap();
  b.set_displacement(|x| Vector3::new((x[0]*0.1).sin(),(x[1]*0.2).sin(),(x[2]*0.13).cos())*1e-3);
  for _ in 0..2 {b.evaluate_and_break(1,&mut ()).unwrap();}
  let mut ts=vec![]; for _ in 0..5 { let t=std::time::Instant::now(); b.evaluate_and_break(1,&mut ()).unwrap(); ts.push(t.elapsed().as_secs_f64()); }
  ts.sort_by(f64::total_cmp); println!("{name} {}: {:.2} ns/bond  mem {:?}", T::NAME, ts[2]*1e9/bonds as f64, b.memory().total()/n/n/n);
}
fn main(){ rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap().install(|| {
 time::<f64,_,_>("pmb", Pmb, NoDamage); time::<f64,_,_>("pmb dmg", Pmb, Breaking::new(Stretch)); time::<f32,_,_>("pmb dmg", Pmb, Breaking::new(Stretch));
 time::<f64,_,_>("lps", Lps, NoDamage); time::<f64,_,_>("lps dmg", Lps, Breaking::new(Stretch)); time::<f32,_,_>("lps dmg", Lps, Breaking::new(Stretch));
 time::<f64,_,_>("nosb", Nosb, NoDamage); time::<f32,_,_>("nosb", Nosb, NoDamage);
});}
