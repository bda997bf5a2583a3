//! rubber that stiffens: cubic in the first invariant; derived from its text by `cargo xtask kernels`, and not changed by hand.
//!
//! ```text
//! Ψ = c1*x + c2*x^2 + c3*x^3 + k/2*(J - 1)^2
//! x = I1_bar - 3
//! ```

use souple_math::{Mat3, Real};

use crate::materials::invariants::cofactor_differential;
use crate::materials::{Law, Parameters};

/// See the module.
#[derive(Clone, Copy, Debug)]
pub struct Yeoh;

/// The law's numbers.
#[derive(Clone, Copy, Debug)]
pub struct Numbers<R> {
    pub c1: R,
    pub c2: R,
    pub c3: R,
    pub k: R,
}

impl<R: Copy> Parameters<R> for Numbers<R> {
    const NAMES: &'static [&'static str] = &["c1", "c2", "c3", "k"];

    #[inline(always)]
    fn unpack(mut number: impl FnMut(usize) -> R) -> Self {
        Self { c1: number(0), c2: number(1), c3: number(2), k: number(3) }
    }

    #[inline(always)]
    fn pack(self, mut put: impl FnMut(usize, R)) {
        put(0, self.c1);
        put(1, self.c2);
        put(2, self.c3);
        put(3, self.k);
    }
}

/// What differentials at one `F` share.
#[derive(Clone, Copy, Debug)]
pub struct Point<R> {
    F: Mat3<R>,
    M1: Mat3<R>,
    s1: R,
    s20: R,
    s24: R,
    s29: R,
    s31: R,
    s36: R,
    s38: R,
    s39: R,
    s44: R,
    s47: R,
    s50: R,
    s55: R,
    s56: R,
    s58: R,
    s62: R,
    s67: R,
    s69: R,
    s74: R,
    s79: R,
    s84: R,
    s88: R,
    s93: R,
    s94: R,
    s97: R,
    s99: R,
    s102: R,
    s105: R,
    s111: R,
}

impl Law for Yeoh {
    type Parameters<R: Real> = Numbers<R>;
    type Point<R: Real> = Point<R>;

    #[inline(always)]
    fn at<R: Real>(p: &Numbers<R>, F: &Mat3<R>) -> Point<R> {
        let F = *F;
        let one = F.columns[0].x.one();
        let M1 = F.cofactor(); // cof(F)
        let s1 = F.columns[0].dot(M1.columns[0]); // det(F)
        let s2 = s1.select_less(one.splat(0.05), s1, one.splat(0.05)); // if(det(F) < 0.05, det(F), 0.05)
        let s3 = s2 * -20.0; // -20*if(det(F) < 0.05, det(F), 0.05)
        let s4 = s3 + 2.0; // 2 - 20*if(det(F) < 0.05, det(F), 0.05)
        let s5 = s2.mul_add(one.splat(20.0), one.splat(-1.0)); // 20*if(det(F) < 0.05, det(F), 0.05) - 1
        let s6 = s5 * s5;
        let s7 = s3 + s6;
        let s8 = s7 + 1.0;
        let s9 = s8.mul_add(one.splat(2.0), one);
        let s10 = s4 * 0.05;
        let s11 = s10 / s9;
        let s12 = s1.select_less(one.splat(0.05), s11, s1);
        let s13 = super::power(s12, one.splat(-0.6666666666666666));
        let s14 = s13 / s12;
        let s15 = s1.select_less(one.splat(0.05), one, one.splat(0.0)); // if(det(F) < 0.05, 1, 0)
        let s16 = s15 * -1.0;
        let s17 = s16 / s9;
        let s18 = s9 * s9;
        let s19 = one / s18;
        let s20 = s5 * 40.0;
        let s21 = s15 * -20.0;
        let s22 = s20.mul_add(s15, s21);
        let s23 = s4 * -0.1;
        let s24 = s23 * s19;
        let s25 = s24.mul_add(s22, s17);
        let s26 = s1.select_less(one.splat(0.05), s25, one);
        let s27 = p.c1 * -1.3333333333333333;
        let s28 = s27 * s14;
        let s29 = s28 * s26;
        let s30 = F.dot(&F); // dot(F, F)
        let s31 = one.splat(-1.0) / s9;
        let s32 = super::whole_power(s13, 4);
        let s33 = p.c1 * 1.1111111111111112;
        let s34 = s33 * s30;
        let s35 = s34 * s26;
        let s36 = s35 * s32;
        let s37 = s19 * 2.0;
        let s38 = s37 * s15;
        let s39 = s37 * s22;
        let s40 = super::whole_power(s9, 3);
        let s41 = one / s40;
        let s42 = s4 * 0.4;
        let s43 = s42 * s22;
        let s44 = s43 * s41;
        let s45 = s4 * -80.0;
        let s46 = s45 * s19;
        let s47 = s46 * s15;
        let s48 = p.c1 * -0.6666666666666666;
        let s49 = s48 * s30;
        let s50 = s49 * s14;
        let s51 = s30.mul_add(s13, one.splat(-3.0));
        let s52 = p.c2 * -2.6666666666666665;
        let s53 = s52 * s51;
        let s54 = s53 * s14;
        let s55 = s54 * s26;
        let s56 = s13 * 2.0;
        let s57 = s30 * -0.6666666666666666;
        let s58 = s57 * s14;
        let s59 = s30 * -1.3333333333333333;
        let s60 = s59 * p.c2;
        let s61 = s60 * s14;
        let s62 = s61 * s26;
        let s63 = s30 * 2.2222222222222223;
        let s64 = s63 * p.c2;
        let s65 = s64 * s51;
        let s66 = s65 * s26;
        let s67 = s66 * s32;
        let s68 = s60 * s51;
        let s69 = s68 * s14;
        let s70 = s51 * s51;
        let s71 = p.c3 * -4.0;
        let s72 = s71 * s70;
        let s73 = s72 * s14;
        let s74 = s73 * s26;
        let s75 = s30 * -4.0;
        let s76 = s75 * p.c3;
        let s77 = s76 * s51;
        let s78 = s77 * s14;
        let s79 = s78 * s26;
        let s80 = s30 * 3.3333333333333335;
        let s81 = s80 * p.c3;
        let s82 = s81 * s70;
        let s83 = s82 * s26;
        let s84 = s83 * s32;
        let s85 = s30 * -2.0;
        let s86 = s85 * p.c3;
        let s87 = s86 * s70;
        let s88 = s87 * s14;
        let s89 = s1 - 1.0; // det(F) - 1
        let s90 = p.k * s89;
        let s91 = s50.mul_add(s26, s90);
        let s92 = s69.mul_add(s26, s91);
        let s93 = s88.mul_add(s26, s92);
        let s94 = s48 * s14;
        let s95 = p.c2 * -1.3333333333333333;
        let s96 = s95 * s51;
        let s97 = s96 * s14;
        let s98 = p.c2 * 2.0;
        let s99 = s98 * s13;
        let s100 = p.c3 * -2.0;
        let s101 = s100 * s70;
        let s102 = s101 * s14;
        let s103 = p.c3 * 6.0;
        let s104 = s103 * s13;
        let s105 = s104 * s51;
        let s106 = p.c3 * 3.0;
        let s107 = s106 * s13;
        let s108 = p.c1 * s13;
        let s109 = s99.mul_add(s51, s108);
        let s110 = s107.mul_add(s70, s109);
        let s111 = s110 * 2.0;
        Point {
            F,
            M1,
            s1,
            s20,
            s24,
            s29,
            s31,
            s36,
            s38,
            s39,
            s44,
            s47,
            s50,
            s55,
            s56,
            s58,
            s62,
            s67,
            s69,
            s74,
            s79,
            s84,
            s88,
            s93,
            s94,
            s97,
            s99,
            s102,
            s105,
            s111,
        }
    }

    #[inline(always)]
    fn energy_density<R: Real>(p: &Numbers<R>, F: &Mat3<R>) -> R {
        let F = *F;
        let one = F.columns[0].x.one();
        let s1 = F.determinant(); // det(F)
        let s2 = s1 - 1.0; // det(F) - 1
        let s3 = s2 * s2; // (det(F) - 1)^2
        let s4 = p.k * 0.5;
        let s5 = F.dot(&F); // dot(F, F)
        let s6 = s1.select_less(one.splat(0.05), s1, one.splat(0.05)); // if(det(F) < 0.05, det(F), 0.05)
        let s7 = s6 * -20.0; // -20*if(det(F) < 0.05, det(F), 0.05)
        let s8 = s7 + 2.0; // 2 - 20*if(det(F) < 0.05, det(F), 0.05)
        let s9 = s6.mul_add(one.splat(20.0), one.splat(-1.0)); // 20*if(det(F) < 0.05, det(F), 0.05) - 1
        let s10 = s9 * s9;
        let s11 = s7 + s10;
        let s12 = s11 + 1.0;
        let s13 = s12.mul_add(one.splat(2.0), one);
        let s14 = s8 * 0.05;
        let s15 = s14 / s13;
        let s16 = s1.select_less(one.splat(0.05), s15, s1);
        let s17 = super::power(s16, one.splat(-0.6666666666666666));
        let s18 = s5.mul_add(s17, one.splat(-3.0));
        let s19 = s18 * s18;
        let s20 = super::whole_power(s18, 3);
        let s21 = s4 * s3;
        let s22 = p.c1.mul_add(s18, s21);
        let s23 = p.c2.mul_add(s19, s22);
        p.c3.mul_add(s20, s23)
    }

    #[inline(always)]
    fn stress<R: Real>(p: &Numbers<R>, F: &Mat3<R>) -> Mat3<R> {
        let F = *F;
        let one = F.columns[0].x.one();
        let M1 = F.cofactor(); // cof(F)
        let s1 = F.columns[0].dot(M1.columns[0]); // det(F)
        let s2 = s1 - 1.0; // det(F) - 1
        let s3 = F.dot(&F); // dot(F, F)
        let s4 = s1.select_less(one.splat(0.05), s1, one.splat(0.05)); // if(det(F) < 0.05, det(F), 0.05)
        let s5 = s4 * -20.0; // -20*if(det(F) < 0.05, det(F), 0.05)
        let s6 = s5 + 2.0; // 2 - 20*if(det(F) < 0.05, det(F), 0.05)
        let s7 = s4.mul_add(one.splat(20.0), one.splat(-1.0)); // 20*if(det(F) < 0.05, det(F), 0.05) - 1
        let s8 = s7 * s7;
        let s9 = s5 + s8;
        let s10 = s9 + 1.0;
        let s11 = s10.mul_add(one.splat(2.0), one);
        let s12 = s6 * 0.05;
        let s13 = s12 / s11;
        let s14 = s1.select_less(one.splat(0.05), s13, s1);
        let s15 = super::power(s14, one.splat(-0.6666666666666666));
        let s16 = s15 / s14;
        let s17 = s1.select_less(one.splat(0.05), one, one.splat(0.0)); // if(det(F) < 0.05, 1, 0)
        let s18 = s17 * -1.0;
        let s19 = s18 / s11;
        let s20 = s11 * s11;
        let s21 = one / s20;
        let s22 = s7 * 40.0;
        let s23 = s17 * -20.0;
        let s24 = s22.mul_add(s17, s23);
        let s25 = s6 * -0.1;
        let s26 = s25 * s21;
        let s27 = s26.mul_add(s24, s19);
        let s28 = s1.select_less(one.splat(0.05), s27, one);
        let s29 = p.c1 * -0.6666666666666666;
        let s30 = s29 * s3;
        let s31 = s30 * s16;
        let s32 = s3.mul_add(s15, one.splat(-3.0));
        let s33 = s3 * -1.3333333333333333;
        let s34 = s33 * p.c2;
        let s35 = s34 * s32;
        let s36 = s35 * s16;
        let s37 = s32 * s32;
        let s38 = s3 * -2.0;
        let s39 = s38 * p.c3;
        let s40 = s39 * s37;
        let s41 = s40 * s16;
        let s42 = p.k * s2;
        let s43 = s31.mul_add(s28, s42);
        let s44 = s36.mul_add(s28, s43);
        let s45 = s41.mul_add(s28, s44);
        let s46 = p.c2 * 2.0;
        let s47 = s46 * s15;
        let s48 = p.c3 * 3.0;
        let s49 = s48 * s15;
        let s50 = p.c1 * s15;
        let s51 = s47.mul_add(s32, s50);
        let s52 = s49.mul_add(s37, s51);
        let s53 = s52 * 2.0;
        M1.scaled(s45) + F.scaled(s53)
    }

    #[inline(always)]
    fn stress_differential<R: Real>(p: &Numbers<R>, point: &Point<R>, dF: &Mat3<R>) -> Mat3<R> {
        let dF = *dF;
        let one = dF.columns[0].x.one();
        let s112 = dF.dot(&point.M1); // dot(dF, cof(F))
        let s113 = point.F.dot(&dF); // dot(F, dF)
        let s114 = point.s1.select_less(one.splat(0.05), s112, one.splat(0.0)); // if(det(F) < 0.05, dot(dF, cof(F)), 0)
        let s115 = s114 * -20.0;
        let s116 = point.s20.mul_add(s114, s115);
        let s117 = point.s31 * s114;
        let s118 = point.s24.mul_add(s116, s117);
        let s119 = point.s1.select_less(one.splat(0.05), s118, s112);
        let s120 = point.s38 * s116;
        let s121 = point.s39.mul_add(s114, s120);
        let s122 = point.s44.mul_add(s116, s121);
        let s123 = point.s47.mul_add(s114, s122);
        let s124 = point.s1.select_less(one.splat(0.05), s123, one.splat(0.0));
        let s125 = point.s56 * s113;
        let s126 = point.s58.mul_add(s119, s125);
        let s127 = p.k * s112;
        let s128 = point.s29.mul_add(s113, s127);
        let s129 = point.s36.mul_add(s119, s128);
        let s130 = point.s50.mul_add(s124, s129);
        let s131 = point.s55.mul_add(s113, s130);
        let s132 = point.s62.mul_add(s126, s131);
        let s133 = point.s67.mul_add(s119, s132);
        let s134 = point.s69.mul_add(s124, s133);
        let s135 = point.s74.mul_add(s113, s134);
        let s136 = point.s79.mul_add(s126, s135);
        let s137 = point.s84.mul_add(s119, s136);
        let s138 = point.s88.mul_add(s124, s137);
        let M2 = cofactor_differential(&point.F, &dF); // cross(F, dF)
        let s139 = point.s94 * s119;
        let s140 = point.s97.mul_add(s119, s139);
        let s141 = point.s99.mul_add(s126, s140);
        let s142 = point.s102.mul_add(s119, s141);
        let s143 = point.s105.mul_add(s126, s142);
        let s144 = s143 * 2.0;
        let M3 = point.M1.scaled(s138) + M2.scaled(point.s93);
        let M4 = point.F.scaled(s144) + M3;
        dF.scaled(point.s111) + M4
    }
}
