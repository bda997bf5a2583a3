//! rubber that stiffens: cubic in the first invariant; derived from its text by `souple derive --emit kernel`, and not changed by hand.
//!
//! ```text
//! Ψ = c1*x + c2*x^2 + c3*x^3 + k/2*(J - 1)^2
//! x = I1_bar - 3
//! ```

use souple_math::{Mat3, Real, Vec3};

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
    s19: R,
    s24: R,
    s26: R,
    s27: R,
    s32: R,
    s33: R,
    s34: R,
    s39: R,
    s41: R,
    s44: R,
    s49: R,
    s50: R,
    s52: R,
    s56: R,
    s61: R,
    s63: R,
    s68: R,
    s73: R,
    s78: R,
    s82: R,
    s87: R,
    s88: R,
    s91: R,
    s93: R,
    s96: R,
    s99: R,
    s105: R,
    M2: Mat3<R>,
    s148: R,
    M3: Mat3<R>,
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
        let s13 = s12 / s11;
        let s14 = one.splat(-1.0) / s8;
        let s15 = s8 * s8;
        let s16 = one / s15;
        let s17 = s4.mul_add(one.splat(40.0), one.splat(-20.0)); // 40*(20*det(F) - 1) - 20
        let s18 = s3 * -0.1;
        let s19 = s18 * s16;
        let s20 = s19.mul_add(s17, s14);
        let s21 = s1.select_less(one.splat(0.05), s20, one);
        let s22 = p.c1 * -1.3333333333333333;
        let s23 = s22 * s13;
        let s24 = s23 * s21;
        let s25 = F.dot(&F); // dot(F, F)
        let s26 = one.splat(-1.0) / s8;
        let s27 = s4 * 40.0;
        let s28 = super::whole_power(s12, 4);
        let s29 = p.c1 * 1.1111111111111112;
        let s30 = s29 * s25;
        let s31 = s30 * s21;
        let s32 = s31 * s28;
        let s33 = s16 * 2.0;
        let s34 = s33 * s17;
        let s35 = super::whole_power(s8, 3);
        let s36 = one / s35;
        let s37 = s3 * 0.4;
        let s38 = s37 * s17;
        let s39 = s38 * s36;
        let s40 = s3 * -80.0;
        let s41 = s40 * s16;
        let s42 = p.c1 * -0.6666666666666666;
        let s43 = s42 * s25;
        let s44 = s43 * s13;
        let s45 = s25.mul_add(s12, one.splat(-3.0));
        let s46 = p.c2 * -2.6666666666666665;
        let s47 = s46 * s45;
        let s48 = s47 * s13;
        let s49 = s48 * s21;
        let s50 = s12 * 2.0;
        let s51 = s25 * -0.6666666666666666;
        let s52 = s51 * s13;
        let s53 = s25 * -1.3333333333333333;
        let s54 = s53 * p.c2;
        let s55 = s54 * s13;
        let s56 = s55 * s21;
        let s57 = s25 * 2.2222222222222223;
        let s58 = s57 * p.c2;
        let s59 = s58 * s45;
        let s60 = s59 * s21;
        let s61 = s60 * s28;
        let s62 = s54 * s45;
        let s63 = s62 * s13;
        let s64 = s45 * s45;
        let s65 = p.c3 * -4.0;
        let s66 = s65 * s64;
        let s67 = s66 * s13;
        let s68 = s67 * s21;
        let s69 = s25 * -4.0;
        let s70 = s69 * p.c3;
        let s71 = s70 * s45;
        let s72 = s71 * s13;
        let s73 = s72 * s21;
        let s74 = s25 * 3.3333333333333335;
        let s75 = s74 * p.c3;
        let s76 = s75 * s64;
        let s77 = s76 * s21;
        let s78 = s77 * s28;
        let s79 = s25 * -2.0;
        let s80 = s79 * p.c3;
        let s81 = s80 * s64;
        let s82 = s81 * s13;
        let s83 = s1 - 1.0; // det(F) - 1
        let s84 = p.k * s83;
        let s85 = s44.mul_add(s21, s84);
        let s86 = s63.mul_add(s21, s85);
        let s87 = s82.mul_add(s21, s86);
        let s88 = s42 * s13;
        let s89 = p.c2 * -1.3333333333333333;
        let s90 = s89 * s45;
        let s91 = s90 * s13;
        let s92 = p.c2 * 2.0;
        let s93 = s92 * s12;
        let s94 = p.c3 * -2.0;
        let s95 = s94 * s64;
        let s96 = s95 * s13;
        let s97 = p.c3 * 6.0;
        let s98 = s97 * s12;
        let s99 = s98 * s45;
        let s100 = p.c3 * 3.0;
        let s101 = s100 * s12;
        let s102 = p.c1 * s12;
        let s103 = s93.mul_add(s45, s102);
        let s104 = s101.mul_add(s64, s103);
        let s105 = s104 * 2.0;
        let s106 = s21 * s21;
        let s107 = s30 * s28;
        let s108 = s17 * s17; // (40*(20*det(F) - 1) - 20)^2
        let s109 = s37 * s36;
        let s110 = s16 * 4.0;
        let s111 = s109 * s108;
        let s112 = s40.mul_add(s16, s111);
        let s113 = s110.mul_add(s17, s112);
        let s114 = s1.select_less(one.splat(0.05), s113, one.splat(0.0));
        let s115 = s25 * s25; // dot(F, F)^2
        let s116 = s13 * s13;
        let s117 = p.c2 * 0.8888888888888888;
        let s118 = s117 * s106;
        let s119 = s118 * s115;
        let s120 = s59 * s28;
        let s121 = p.c3 * 2.6666666666666665;
        let s122 = s121 * s45;
        let s123 = s122 * s106;
        let s124 = s123 * s115;
        let s125 = s76 * s28;
        let s126 = s107.mul_add(s106, p.k);
        let s127 = s44.mul_add(s114, s126);
        let s128 = s119.mul_add(s116, s127);
        let s129 = s120.mul_add(s106, s128);
        let s130 = s63.mul_add(s114, s129);
        let s131 = s124.mul_add(s116, s130);
        let s132 = s125.mul_add(s106, s131);
        let s133 = s82.mul_add(s114, s132);
        let s134 = s12 * s12;
        let s135 = s134 / s11;
        let s136 = s25 * -2.6666666666666665;
        let s137 = s136 * p.c2;
        let s138 = s137 * s21;
        let s139 = s25 * -8.0;
        let s140 = s139 * p.c3;
        let s141 = s140 * s45;
        let s142 = s141 * s21;
        let s143 = s23 * s21;
        let s144 = s48.mul_add(s21, s143);
        let s145 = s138.mul_add(s135, s144);
        let s146 = s67.mul_add(s21, s145);
        let s147 = s142.mul_add(s135, s146);
        let M2 = M1.scaled(s133) + F.scaled(s147);
        let s148 = s87 * -1.0;
        let s149 = s54 * s21;
        let s150 = s71 * s21;
        let s151 = s88 * s21;
        let s152 = s91.mul_add(s21, s151);
        let s153 = s149.mul_add(s135, s152);
        let s154 = s96.mul_add(s21, s153);
        let s155 = s150.mul_add(s135, s154);
        let s156 = s155 * 2.0;
        let s157 = p.c2 * 4.0;
        let s158 = p.c3 * 12.0;
        let s159 = s158 * s45;
        let s160 = s157 * s134;
        let s161 = s159.mul_add(s134, s160);
        let s162 = s161 * 2.0;
        let M3 = M1.scaled(s156) + F.scaled(s162);
        Point {
            F,
            M1,
            s1,
            s19,
            s24,
            s26,
            s27,
            s32,
            s33,
            s34,
            s39,
            s41,
            s44,
            s49,
            s50,
            s52,
            s56,
            s61,
            s63,
            s68,
            s73,
            s78,
            s82,
            s87,
            s88,
            s91,
            s93,
            s96,
            s99,
            s105,
            M2,
            s148,
            M3,
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
        let s18 = s17 * s17;
        let s19 = super::whole_power(s17, 3);
        let s20 = s4 * s3;
        let s21 = p.c1.mul_add(s17, s20);
        let s22 = p.c2.mul_add(s18, s21);
        p.c3.mul_add(s19, s22)
    }

    #[inline(always)]
    fn stress<R: Real>(p: &Numbers<R>, F: &Mat3<R>) -> Mat3<R> {
        let F = *F;
        let one = F.columns[0].x.one();
        let M1 = F.cofactor(); // cof(F)
        let s1 = F.columns[0].dot(M1.columns[0]); // det(F)
        let s2 = s1 - 1.0; // det(F) - 1
        let s3 = F.dot(&F); // dot(F, F)
        let s4 = s1 * -20.0; // -20*det(F)
        let s5 = s4 + 2.0; // 2 - 20*det(F)
        let s6 = s1.mul_add(one.splat(20.0), one.splat(-1.0)); // 20*det(F) - 1
        let s7 = s6 * s6; // (20*det(F) - 1)^2
        let s8 = s4 + s7;
        let s9 = s8 + 1.0; // 1 + (20*det(F) - 1)^2 - 20*det(F)
        let s10 = s9.mul_add(one.splat(2.0), one);
        let s11 = s5 * 0.05;
        let s12 = s11 / s10;
        let s13 = s1.select_less(one.splat(0.05), s12, s1);
        let s14 = super::power(s13, one.splat(-0.6666666666666666));
        let s15 = s14 / s13;
        let s16 = one.splat(-1.0) / s10;
        let s17 = s10 * s10;
        let s18 = one / s17;
        let s19 = s6.mul_add(one.splat(40.0), one.splat(-20.0)); // 40*(20*det(F) - 1) - 20
        let s20 = s5 * -0.1;
        let s21 = s20 * s18;
        let s22 = s21.mul_add(s19, s16);
        let s23 = s1.select_less(one.splat(0.05), s22, one);
        let s24 = p.c1 * -0.6666666666666666;
        let s25 = s24 * s3;
        let s26 = s25 * s15;
        let s27 = s3.mul_add(s14, one.splat(-3.0));
        let s28 = s3 * -1.3333333333333333;
        let s29 = s28 * p.c2;
        let s30 = s29 * s27;
        let s31 = s30 * s15;
        let s32 = s27 * s27;
        let s33 = s3 * -2.0;
        let s34 = s33 * p.c3;
        let s35 = s34 * s32;
        let s36 = s35 * s15;
        let s37 = p.k * s2;
        let s38 = s26.mul_add(s23, s37);
        let s39 = s31.mul_add(s23, s38);
        let s40 = s36.mul_add(s23, s39);
        let s41 = p.c2 * 2.0;
        let s42 = s41 * s14;
        let s43 = p.c3 * 3.0;
        let s44 = s43 * s14;
        let s45 = p.c1 * s14;
        let s46 = s42.mul_add(s27, s45);
        let s47 = s44.mul_add(s32, s46);
        let s48 = s47 * 2.0;
        M1.scaled(s40) + F.scaled(s48)
    }

    #[inline(always)]
    fn stress_differential<R: Real>(p: &Numbers<R>, point: &Point<R>, dF: &Mat3<R>) -> Mat3<R> {
        let dF = *dF;
        let one = dF.columns[0].x.one();
        let s163 = dF.dot(&point.M1); // dot(dF, cof(F))
        let s164 = point.F.dot(&dF); // dot(F, dF)
        let s165 = s163 * -20.0;
        let s166 = point.s27.mul_add(s163, s165);
        let s167 = point.s26 * s163;
        let s168 = point.s19.mul_add(s166, s167);
        let s169 = point.s1.select_less(one.splat(0.05), s168, s163);
        let s170 = point.s33 * s166;
        let s171 = point.s34.mul_add(s163, s170);
        let s172 = point.s39.mul_add(s166, s171);
        let s173 = point.s41.mul_add(s163, s172);
        let s174 = point.s1.select_less(one.splat(0.05), s173, one.splat(0.0));
        let s175 = point.s50 * s164;
        let s176 = point.s52.mul_add(s169, s175);
        let s177 = p.k * s163;
        let s178 = point.s24.mul_add(s164, s177);
        let s179 = point.s32.mul_add(s169, s178);
        let s180 = point.s44.mul_add(s174, s179);
        let s181 = point.s49.mul_add(s164, s180);
        let s182 = point.s56.mul_add(s176, s181);
        let s183 = point.s61.mul_add(s169, s182);
        let s184 = point.s63.mul_add(s174, s183);
        let s185 = point.s68.mul_add(s164, s184);
        let s186 = point.s73.mul_add(s176, s185);
        let s187 = point.s78.mul_add(s169, s186);
        let s188 = point.s82.mul_add(s174, s187);
        let M4 = cofactor_differential(&point.F, &dF); // cross(F, dF)
        let s189 = point.s88 * s169;
        let s190 = point.s91.mul_add(s169, s189);
        let s191 = point.s93.mul_add(s176, s190);
        let s192 = point.s96.mul_add(s169, s191);
        let s193 = point.s99.mul_add(s176, s192);
        let s194 = s193 * 2.0;
        let M5 = point.M1.scaled(s188) + M4.scaled(point.s87);
        let M6 = point.F.scaled(s194) + M5;
        dF.scaled(point.s105) + M6
    }

    #[inline(always)]
    fn tangent_block<R: Real>(_: &Numbers<R>, point: &Point<R>, g_a: Vec3<R>, g_b: Vec3<R>) -> Mat3<R> {
        let one = g_a.x.one();
        let v1 = point.M1 * g_a; // cof(F)*g_a
        let v2 = point.M2 * g_b;
        let M8 = v1.outer(v2);
        let s195 = g_b.z * -1.0;
        let s196 = g_b.y * g_a.z;
        let s197 = s195.mul_add(g_a.y, s196);
        let s198 = g_b.x * -1.0;
        let s199 = g_b.z * g_a.x;
        let s200 = s198.mul_add(g_a.z, s199);
        let s201 = g_b.y * -1.0;
        let s202 = g_b.x * g_a.y;
        let s203 = s201.mul_add(g_a.x, s202);
        let v3 = Vec3::new(s197, s200, s203);
        let v4 = point.F * v3;
        let s204 = point.s87 * v4.z;
        let s205 = point.s148 * v4.y;
        let s206 = point.s148 * v4.z;
        let s207 = point.s87 * v4.x;
        let s208 = point.s87 * v4.y;
        let s209 = point.s148 * v4.x;
        let M9 = Mat3::from_columns(
            Vec3::new(one.splat(0.0), s204, s205),
            Vec3::new(s206, one.splat(0.0), s207),
            Vec3::new(s208, s209, one.splat(0.0)),
        );
        let M10 = M8 + M9;
        let v5 = point.F * g_a; // F*g_a
        let v6 = point.M3 * g_b;
        let M11 = v5.outer(v6);
        let M12 = M10 + M11;
        let s210 = g_a.dot(g_b); // dot(g_a, g_b)
        let s211 = point.s105 * s210;
        M12.plus_diagonal(s211)
    }
}
