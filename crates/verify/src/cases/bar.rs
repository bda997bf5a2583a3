//! Settings of the reference bar that its cases share.

pub(super) const LINEAR: &str = r#"bodies.bar.material.name="linear""#;
pub(super) const COROTATIONAL: &str = r#"bodies.bar.material.name="corotational""#;
pub(super) const NEO_HOOKEAN: &str = r#"bodies.bar.material.name="neo_hookean""#;
pub(super) const ST_VENANT_KIRCHHOFF: &str = r#"bodies.bar.material.name="st_venant_kirchhoff""#;

pub(super) const TET4: &str = r#"bodies.bar.mesh.element="tet4""#;
pub(super) const HEX8: &str = r#"bodies.bar.mesh.element="hex8""#;
pub(super) const PRISM6: &str = r#"bodies.bar.mesh.element="prism6""#;
pub(super) const PYRAMID5: &str = r#"bodies.bar.mesh.element="pyramid5""#;

pub(super) const DEFAULT_RULE: &str = r#"bodies.bar.quadrature="default""#;
pub(super) const FULL_RULE: &str = r#"bodies.bar.quadrature="full""#;

// n cells across the bar, 10 n along it
pub(super) const N1: &str = "bodies.bar.mesh.cells=[10, 1, 1]";
pub(super) const N2: &str = "bodies.bar.mesh.cells=[20, 2, 2]";
pub(super) const N3: &str = "bodies.bar.mesh.cells=[30, 3, 3]";
pub(super) const N4: &str = "bodies.bar.mesh.cells=[40, 4, 4]";
pub(super) const N6: &str = "bodies.bar.mesh.cells=[60, 6, 6]";
pub(super) const N8: &str = "bodies.bar.mesh.cells=[80, 8, 8]";
pub(super) const N12: &str = "bodies.bar.mesh.cells=[120, 12, 12]";
