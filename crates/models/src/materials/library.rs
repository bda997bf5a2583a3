//! Laws of the literature as text, ready to be put into a scene or to be derived on an element.

use souple_formal::law::LawText;

use super::{Lame, MaterialError, TextLaw, law_text};

/// A law as one writes it in a scene.
#[derive(Clone, Copy, Debug)]
pub struct WrittenLaw {
    pub name: &'static str,
    pub summary: &'static str,
    pub source: &'static str,
    pub energy: &'static str,
    /// Names with values of soft tissue or rubber.
    pub parameters: &'static [(&'static str, &'static str)],
    pub definitions: &'static [(&'static str, &'static str)],
}

/// All of them.
pub const WRITTEN_LAWS: &[WrittenLaw] = &[
    WrittenLaw {
        name: "linear",
        summary: "Hooke's law of small strain",
        source: "Love 1892, A Treatise on the Mathematical Theory of Elasticity",
        energy: "lambda/2*tr(eps)^2 + mu*dot(eps, eps)",
        parameters: &[("lambda", "20 kPa"), ("mu", "10 kPa")],
        definitions: &[],
    },
    WrittenLaw {
        name: "st_venant_kirchhoff",
        summary: "quadratic in Green strain",
        source: "Sifakis & Barbič 2012, FEM Simulation of 3D Deformable Solids, §3.3",
        energy: "lambda/2*tr(E)^2 + mu*dot(E, E)",
        parameters: &[("lambda", "20 kPa"), ("mu", "10 kPa")],
        definitions: &[],
    },
    WrittenLaw {
        name: "neo_hookean",
        summary: "the logarithmic form",
        source: "Bonet & Wood 2008, Nonlinear Continuum Mechanics for Finite Element Analysis, §6.4.3",
        energy: "mu/2*(I1 - 3) - mu*log(J) + lambda/2*log(J)^2",
        parameters: &[("lambda", "20 kPa"), ("mu", "10 kPa")],
        definitions: &[],
    },
    WrittenLaw {
        name: "corotational",
        summary: "Hooke's law in the frame that turns with the matter, by principal stretches",
        source: "Müller & Gross 2004; Sifakis & Barbič 2012, §3.4",
        energy: "mu*((l1 - 1)^2 + (l2 - 1)^2 + (l3 - 1)^2) + lambda/2*(l1 + l2 + l3 - 3)^2",
        parameters: &[("lambda", "20 kPa"), ("mu", "10 kPa")],
        definitions: &[],
    },
    WrittenLaw {
        name: "stable_neo_hookean",
        summary: "smooth for every deformation, inverted ones too",
        source: "Smith, de Goes & Kim 2018, Stable Neo-Hookean Flesh Simulation, eq. 14",
        energy: "m/2*(I1 - 3 - log((I1 + 1)/4)) + l/2*(J - 1)^2 - 3/4*m*(J - 1)",
        parameters: &[("lambda", "20 kPa"), ("mu", "10 kPa")],
        definitions: &[("m", "4/3*mu"), ("l", "lambda + 5/6*mu")],
    },
    WrittenLaw {
        name: "mooney_rivlin",
        summary: "rubber at moderate stretch; two isochoric invariants",
        source: "Mooney 1940; Rivlin 1948; decoupled form after Holzapfel 2000, Nonlinear Solid Mechanics, §6.5",
        energy: "c10*(I1_bar - 3) + c01*(I2_bar - 3) + k/2*(J - 1)^2",
        parameters: &[("c10", "4 kPa"), ("c01", "1 kPa"), ("k", "100 kPa")],
        definitions: &[],
    },
    WrittenLaw {
        name: "yeoh",
        summary: "rubber that stiffens: cubic in the first invariant",
        source: "Yeoh 1993, Some forms of the strain energy function for rubber",
        energy: "c1*x + c2*x^2 + c3*x^3 + k/2*(J - 1)^2",
        parameters: &[("c1", "5 kPa"), ("c2", "-0.2 kPa"), ("c3", "0.05 kPa"), ("k", "100 kPa")],
        definitions: &[("x", "I1_bar - 3")],
    },
    WrittenLaw {
        name: "ogden",
        summary: "powers of the principal stretches",
        source: "Ogden 1972, Large deformation isotropic elasticity; decoupled form after Holzapfel 2000, §6.5",
        energy: "mu1/a1*(s1^a1 + s2^a1 + s3^a1 - 3) + mu2/a2*(s1^a2 + s2^a2 + s3^a2 - 3) + k/2*(J - 1)^2",
        parameters: &[("mu1", "6 kPa"), ("a1", "1.8"), ("mu2", "-1 kPa"), ("a2", "-2.5"), ("k", "100 kPa")],
        definitions: &[("s1", "J^(-1/3)*l1"), ("s2", "J^(-1/3)*l2"), ("s3", "J^(-1/3)*l3")],
    },
    WrittenLaw {
        name: "fung",
        summary: "soft tissue that stiffens exponentially with Green strain",
        source: "Fung 1993, Biomechanics: Mechanical Properties of Living Tissues, §7.10; isotropic form",
        energy: "c/2*(exp(b*dot(E, E)) - 1) + k/2*(J - 1)^2",
        parameters: &[("c", "10 kPa"), ("b", "4"), ("k", "100 kPa")],
        definitions: &[],
    },
    WrittenLaw {
        name: "holzapfel_gasser_ogden",
        summary: "artery walls: a soft matrix with two families of fibres that bear tension only",
        source: "Holzapfel, Gasser & Ogden 2000, A new constitutive framework for arterial wall mechanics, eq. 63-65",
        energy: "c/2*(I1_bar - 3) + k1/(2*k2)*(exp(k2*e1^2) - 1 + exp(k2*e2^2) - 1) + k/2*(J - 1)^2",
        parameters: &[
            ("c", "3 kPa"),
            ("k1", "2.36 kPa"),
            ("k2", "0.84"),
            ("k", "100 kPa"),
            ("a1", "[0.8746, 0.4848, 0]"),
            ("a2", "[0.8746, -0.4848, 0]"),
        ],
        definitions: &[("e1", "max(J^(-2/3)*I4(a1) - 1, 0)"), ("e2", "max(J^(-2/3)*I4(a2) - 1, 0)")],
    },
];

impl WrittenLaw {
    pub fn find(name: &str) -> Option<&'static Self> {
        WRITTEN_LAWS.iter().find(|law| law.name == name)
    }

    /// The energy with its parts, `energy; name = part`, without numbers.
    pub fn formula(&self) -> String {
        self.definitions
            .iter()
            .fold(self.energy.to_owned(), |text, (name, part)| format!("{text}; {name} = {part}"))
    }

    /// All of it in one text, `energy; name = part; name = value`, as `souple derive --law` reads it.
    pub fn written(&self) -> String {
        self.parameters.iter().fold(self.formula(), |text, (name, value)| format!("{text}; {name} = {value}"))
    }

    /// The law with its values.
    ///
    /// # Errors
    /// A value is no quantity; those here all are.
    pub fn text(&self) -> Result<LawText, MaterialError> {
        let owned = |list: &[(&str, &str)]| -> Vec<(String, String)> {
            list.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned())).collect()
        };
        law_text(self.energy, &owned(self.parameters), &owned(self.definitions))
    }

    /// Moduli at rest with these values; of an anisotropic law the mean shear modulus.
    ///
    /// # Errors
    /// The text is no law; those here all are.
    pub fn small_strain(&self) -> Result<Lame, MaterialError> {
        Ok(TextLaw::compile(self.text()?)?.small_strain())
    }
}

/// A law as its author wrote it, a line for the energy and one for each part.
pub fn lines_of(text: &LawText) -> Vec<String> {
    let parts = text.definitions.iter().map(|(name, part)| format!("{name} = {part}"));
    std::iter::once(format!("Ψ = {}", text.energy)).chain(parts).collect()
}
