//! rubber at moderate stretch; two isochoric invariants; derived from its text by `souple derive --emit kernel`, and not changed by hand.
//!
//! ```text
//! Ψ = c10*(I1_bar - 3) + c01*(I2_bar - 3) + k/2*(J - 1)^2
//! ```

use souple_math::{Mat3, Real, Vec3};

use crate::materials::invariants::cofactor_differential;
use crate::materials::{Law, Parameters};

/// See the module.
#[derive(Clone, Copy, Debug)]
pub struct MooneyRivlin;

/// The law's numbers.
#[derive(Clone, Copy, Debug)]
pub struct Numbers<R> {
    pub c10: R,
    pub c01: R,
    pub k: R,
}

impl<R: Copy> Parameters<R> for Numbers<R> {
    const NAMES: &'static [&'static str] = &["c10", "c01", "k"];

    #[inline(always)]
    fn unpack(mut number: impl FnMut(usize) -> R) -> Self {
        Self { c10: number(0), c01: number(1), k: number(2) }
    }

    #[inline(always)]
    fn pack(self, mut put: impl FnMut(usize, R)) {
        put(0, self.c10);
        put(1, self.c01);
        put(2, self.k);
    }
}

/// What differentials at one `F` share.
#[derive(Clone, Copy, Debug)]
pub struct Point<R> {
    F: Mat3<R>,
    M1: Mat3<R>,
    s1: R,
    s15: R,
    s18: R,
    s20: R,
    s22: R,
    M2: Mat3<R>,
    s24: R,
    s27: R,
    s29: R,
    s33: R,
    M4: Mat3<R>,
    s44: R,
    s49: R,
    s50: R,
    s51: R,
    s56: R,
    s58: R,
    s60: R,
    s61: R,
    s64: R,
    s72: R,
    s74: R,
    s78: R,
    s98: R,
    M7: Mat3<R>,
    s99: R,
    M8: Mat3<R>,
    M9: Mat3<R>,
}

impl Law for MooneyRivlin {
    type Parameters<R: Real> = Numbers<R>;
    type Point<R: Real> = Point<R>;

    #[inline(always)]
    fn at<R: Real>(p: &Numbers<R>, F: &Mat3<R>) -> Point<R> {
        let F = *F;
        let one = F.columns[0].x.one();
        let M1 = F.cofactor(); // cof(F)
        let s1 = F.columns[0].dot(M1.columns[0]); // det(F)
        let s2 = s1 * -20.0; // -20*det(F)
        let s3 = s2 + 2.0; // 2 - 20*det(F)
        let s4 = s1.mul_add(one.splat(20.0), one.splat(-1.0)); // 20*det(F) - 1
        let s5 = s4 * s4; // (20*det(F) - 1)^2
        let s6 = s2 + s5;
        let s7 = s6 + 1.0; // 1 + (20*det(F) - 1)^2 - 20*det(F)
        let s8 = s7.mul_add(one.splat(2.0), one);
        let s9 = s3 * 0.05;
        let s10 = s9 / s8;
        let s11 = s1.select_less(one.splat(0.05), s10, s1);
        let s12 = super::power(s11, one.splat(-0.6666666666666666));
        let s13 = s12 * s12;
        let s14 = s13 / s11;
        let s15 = one.splat(-1.0) / s8;
        let s16 = s8 * s8;
        let s17 = one / s16;
        let s18 = s4 * 40.0;
        let s19 = s3 * -0.1;
        let s20 = s19 * s17;
        let s21 = p.c01 * 2.6666666666666665;
        let s22 = s21 * s14;
        let M2 = F.gram(); // transpose(F)*F
        let s23 = p.c01 * -2.0;
        let s24 = s23 * s13;
        let s25 = s12 / s11;
        let s26 = p.c10 * -0.6666666666666666;
        let s27 = s26 * s25;
        let s28 = p.c01 * 2.0;
        let s29 = s28 * s13;
        let s30 = M2.trace(); // dot(F, F)
        let s31 = s30 * -1.3333333333333333;
        let s32 = s31 * p.c01;
        let s33 = s32 * s14;
        let M3 = M2.scaled(s24);
        let s34 = s30 * p.c01;
        let s35 = p.c10 * s12;
        let s36 = s34.mul_add(s13, s35);
        let s37 = s36 * 2.0;
        let M4 = M3.plus_diagonal(s37);
        let s38 = one.splat(-1.0) / s8;
        let s39 = s4.mul_add(one.splat(40.0), one.splat(-20.0)); // 40*(20*det(F) - 1) - 20
        let s40 = s20.mul_add(s39, s38);
        let s41 = s1.select_less(one.splat(0.05), s40, one);
        let s42 = p.c10 * -1.3333333333333333;
        let s43 = s42 * s25;
        let s44 = s43 * s41;
        let s45 = super::whole_power(s12, 4);
        let s46 = p.c10 * 1.1111111111111112;
        let s47 = s46 * s30;
        let s48 = s47 * s41;
        let s49 = s48 * s45;
        let s50 = s17 * 2.0;
        let s51 = s50 * s39;
        let s52 = super::whole_power(s8, 3);
        let s53 = one / s52;
        let s54 = s3 * 0.4;
        let s55 = s54 * s39;
        let s56 = s55 * s53;
        let s57 = s3 * -80.0;
        let s58 = s57 * s17;
        let s59 = s26 * s30;
        let s60 = s59 * s25;
        let s61 = s30 * 4.0;
        let s62 = p.c01 * -0.6666666666666666;
        let s63 = s62 * s14;
        let s64 = s63 * s41;
        let s65 = s30 * s30; // dot(F, F)^2
        let s66 = M2.dot(&M2);
        let s67 = s66.mul_add(one.splat(-1.0), s65);
        let s68 = s25 * s25;
        let s69 = p.c01 * 1.5555555555555556;
        let s70 = s69 * s67;
        let s71 = s70 * s41;
        let s72 = s71 * s68;
        let s73 = s62 * s67;
        let s74 = s73 * s14;
        let s75 = s1 - 1.0; // det(F) - 1
        let s76 = p.k * s75;
        let s77 = s60.mul_add(s41, s76);
        let s78 = s74.mul_add(s41, s77);
        let s79 = s41 * s41;
        let s80 = s47 * s45;
        let s81 = s39 * s39; // (40*(20*det(F) - 1) - 20)^2
        let s82 = s54 * s53;
        let s83 = s17 * 4.0;
        let s84 = s82 * s81;
        let s85 = s57.mul_add(s17, s84);
        let s86 = s83.mul_add(s39, s85);
        let s87 = s1.select_less(one.splat(0.05), s86, one.splat(0.0));
        let s88 = s70 * s68;
        let s89 = s80.mul_add(s79, p.k);
        let s90 = s60.mul_add(s87, s89);
        let s91 = s88.mul_add(s79, s90);
        let s92 = s74.mul_add(s87, s91);
        let s93 = s30 * -2.6666666666666665;
        let s94 = s93 * p.c01;
        let s95 = s94 * s14;
        let s96 = s43 * s41;
        let s97 = s95.mul_add(s41, s96);
        let s98 = s22 * s41;
        let M5 = F * M2; // F*transpose(F)*F
        let M6 = M1.scaled(s92) + F.scaled(s97);
        let M7 = M5.scaled(s98) + M6;
        let s99 = s78 * -1.0;
        let s100 = s27 * s41;
        let s101 = s33.mul_add(s41, s100);
        let s102 = s101 * 2.0;
        let s103 = p.c01 * 4.0;
        let s104 = s103 * s13;
        let M8 = M1.scaled(s102) + F.scaled(s104);
        let M9 = F.mul_transpose(&F); // F*transpose(F)
        Point {
            F,
            M1,
            s1,
            s15,
            s18,
            s20,
            s22,
            M2,
            s24,
            s27,
            s29,
            s33,
            M4,
            s44,
            s49,
            s50,
            s51,
            s56,
            s58,
            s60,
            s61,
            s64,
            s72,
            s74,
            s78,
            s98,
            M7,
            s99,
            M8,
            M9,
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
        let M1 = F.gram(); // transpose(F)*F
        let s5 = M1.trace(); // dot(F, F)
        let s6 = s1 * -20.0; // -20*det(F)
        let s7 = s6 + 2.0; // 2 - 20*det(F)
        let s8 = s1.mul_add(one.splat(20.0), one.splat(-1.0)); // 20*det(F) - 1
        let s9 = s8 * s8; // (20*det(F) - 1)^2
        let s10 = s6 + s9;
        let s11 = s10 + 1.0; // 1 + (20*det(F) - 1)^2 - 20*det(F)
        let s12 = s11.mul_add(one.splat(2.0), one);
        let s13 = s7 * 0.05;
        let s14 = s13 / s12;
        let s15 = s1.select_less(one.splat(0.05), s14, s1);
        let s16 = super::power(s15, one.splat(-0.6666666666666666));
        let s17 = s5.mul_add(s16, one.splat(-3.0));
        let s18 = s5 * s5; // dot(F, F)^2
        let s19 = M1.dot(&M1);
        let s20 = s19.mul_add(one.splat(-1.0), s18);
        let s21 = s16 * s16;
        let s22 = s20 * 0.5;
        let s23 = s22.mul_add(s21, one.splat(-3.0));
        let s24 = s4 * s3;
        let s25 = p.c10.mul_add(s17, s24);
        p.c01.mul_add(s23, s25)
    }

    #[inline(always)]
    fn stress<R: Real>(p: &Numbers<R>, F: &Mat3<R>) -> Mat3<R> {
        let F = *F;
        let one = F.columns[0].x.one();
        let M1 = F.cofactor(); // cof(F)
        let s1 = F.columns[0].dot(M1.columns[0]); // det(F)
        let s2 = s1 * -20.0; // -20*det(F)
        let s3 = s2 + 2.0; // 2 - 20*det(F)
        let s4 = s1.mul_add(one.splat(20.0), one.splat(-1.0)); // 20*det(F) - 1
        let s5 = s4 * s4; // (20*det(F) - 1)^2
        let s6 = s2 + s5;
        let s7 = s6 + 1.0; // 1 + (20*det(F) - 1)^2 - 20*det(F)
        let s8 = s7.mul_add(one.splat(2.0), one);
        let s9 = s3 * 0.05;
        let s10 = s9 / s8;
        let s11 = s1.select_less(one.splat(0.05), s10, s1);
        let s12 = super::power(s11, one.splat(-0.6666666666666666));
        let s13 = s12 * s12;
        let s14 = p.c01 * -2.0;
        let s15 = s14 * s13;
        let M2 = F.gram(); // transpose(F)*F
        let M3 = M2.scaled(s15);
        let s16 = M2.trace(); // dot(F, F)
        let s17 = s16 * p.c01;
        let s18 = p.c10 * s12;
        let s19 = s17.mul_add(s13, s18);
        let s20 = s19 * 2.0;
        let M4 = M3.plus_diagonal(s20);
        let M5 = F * M4;
        let s21 = s1 - 1.0; // det(F) - 1
        let s22 = s12 / s11;
        let s23 = one.splat(-1.0) / s8;
        let s24 = s8 * s8;
        let s25 = one / s24;
        let s26 = s4.mul_add(one.splat(40.0), one.splat(-20.0)); // 40*(20*det(F) - 1) - 20
        let s27 = s3 * -0.1;
        let s28 = s27 * s25;
        let s29 = s28.mul_add(s26, s23);
        let s30 = s1.select_less(one.splat(0.05), s29, one);
        let s31 = p.c10 * -0.6666666666666666;
        let s32 = s31 * s16;
        let s33 = s32 * s22;
        let s34 = s16 * s16; // dot(F, F)^2
        let s35 = M2.dot(&M2);
        let s36 = s35.mul_add(one.splat(-1.0), s34);
        let s37 = s13 / s11;
        let s38 = p.c01 * -0.6666666666666666;
        let s39 = s38 * s36;
        let s40 = s39 * s37;
        let s41 = p.k * s21;
        let s42 = s33.mul_add(s30, s41);
        let s43 = s40.mul_add(s30, s42);
        M1.scaled(s43) + M5
    }

    #[inline(always)]
    fn stress_differential<R: Real>(p: &Numbers<R>, point: &Point<R>, dF: &Mat3<R>) -> Mat3<R> {
        let dF = *dF;
        let one = dF.columns[0].x.one();
        let s105 = dF.dot(&point.M1); // dot(dF, cof(F))
        let s106 = s105 * -20.0;
        let s107 = point.s18.mul_add(s105, s106);
        let s108 = point.s15 * s105;
        let s109 = point.s20.mul_add(s107, s108);
        let s110 = point.s1.select_less(one.splat(0.05), s109, s105);
        let s111 = point.s22 * s110;
        let M10 = dF.transpose_mul(&point.F); // transpose(dF)*F
        let M11 = M10.transpose(); // transpose(F)*dF
        let M12 = point.M2.scaled(s111) + M10.scaled(point.s24);
        let M13 = M11.scaled(point.s24) + M12;
        let s112 = M10.trace(); // dot(F, dF)
        let s113 = point.s27 * s110;
        let s114 = point.s29.mul_add(s112, s113);
        let s115 = point.s33.mul_add(s110, s114);
        let s116 = s115 * 2.0;
        let M14 = M13.plus_diagonal(s116);
        let M15 = point.F * M14;
        let M16 = dF * point.M4;
        let M17 = M15 + M16;
        let s117 = point.s50 * s107;
        let s118 = point.s51.mul_add(s105, s117);
        let s119 = point.s56.mul_add(s107, s118);
        let s120 = point.s58.mul_add(s105, s119);
        let s121 = point.s1.select_less(one.splat(0.05), s120, one.splat(0.0));
        let M18 = M10 + M11; // transpose(dF)*F + transpose(F)*dF
        let s122 = point.M2.dot(&M18);
        let s123 = point.s61 * s112;
        let s124 = s122.mul_add(one.splat(-2.0), s123);
        let s125 = p.k * s105;
        let s126 = point.s44.mul_add(s112, s125);
        let s127 = point.s49.mul_add(s110, s126);
        let s128 = point.s60.mul_add(s121, s127);
        let s129 = point.s64.mul_add(s124, s128);
        let s130 = point.s72.mul_add(s110, s129);
        let s131 = point.s74.mul_add(s121, s130);
        let M19 = cofactor_differential(&point.F, &dF); // cross(F, dF)
        let M20 = point.M1.scaled(s131) + M17;
        M19.scaled(point.s78) + M20
    }

    #[inline(always)]
    fn tangent_block<R: Real>(_: &Numbers<R>, point: &Point<R>, g_a: Vec3<R>, g_b: Vec3<R>) -> Mat3<R> {
        let one = g_a.x.one();
        let v1 = point.M1 * g_a; // cof(F)*g_a
        let v2 = point.M7 * g_b;
        let M22 = v1.outer(v2);
        let s132 = g_b.z * -1.0;
        let s133 = g_b.y * g_a.z;
        let s134 = s132.mul_add(g_a.y, s133);
        let s135 = g_b.x * -1.0;
        let s136 = g_b.z * g_a.x;
        let s137 = s135.mul_add(g_a.z, s136);
        let s138 = g_b.y * -1.0;
        let s139 = g_b.x * g_a.y;
        let s140 = s138.mul_add(g_a.x, s139);
        let v3 = Vec3::new(s134, s137, s140);
        let v4 = point.F * v3;
        let s141 = point.s78 * v4.z;
        let s142 = point.s99 * v4.y;
        let s143 = point.s99 * v4.z;
        let s144 = point.s78 * v4.x;
        let s145 = point.s78 * v4.y;
        let s146 = point.s99 * v4.x;
        let M23 = Mat3::from_columns(
            Vec3::new(one.splat(0.0), s141, s142),
            Vec3::new(s143, one.splat(0.0), s144),
            Vec3::new(s145, s146, one.splat(0.0)),
        );
        let M24 = M22 + M23;
        let v5 = point.F * g_a; // F*g_a
        let v6 = point.M8 * g_b;
        let M25 = v5.outer(v6);
        let M26 = M24 + M25;
        let v7 = point.F.transpose_apply(v5); // transpose(F)*F*g_a
        let v8 = point.F * v7; // F*transpose(F)*F*g_a
        let v9 = point.M1 * g_b; // cof(F)*g_b
        let v10 = point.F * g_b; // F*g_b
        let s147 = g_a.dot(g_b); // dot(g_a, g_b)
        let s148 = point.s24 * s147;
        let M27 = (v8 * point.s98).outer(v9) + M26;
        let M28 = (v10 * point.s24).outer(v5) + M27;
        let M29 = point.M9.scaled(s148) + M28;
        let v11 = point.M4 * g_a;
        let s149 = g_b.dot(v11);
        M29.plus_diagonal(s149)
    }
}
