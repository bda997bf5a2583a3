// `F = U diag(s) V^T` with rotations `U` and `V`: the last stretch is the least and has the sign of `det F`.
struct Decomposition {
    left: mat3x3<f32>,
    right: mat3x3<f32>,
    stretches: vec3<f32>,
}

// By one-sided Jacobi: columns of `F V` are turned in pairs until they stand across each other, the longer one first.
fn decompose(matrix: mat3x3<f32>) -> Decomposition {
    var left = matrix;
    var right = mat3x3<f32>(vec3<f32>(1.0, 0.0, 0.0), vec3<f32>(0.0, 1.0, 0.0), vec3<f32>(0.0, 0.0, 1.0));
    var pair = 0;
    while (pair < 12) {
        let i = min(pair % 3, (pair + 1) % 3);
        let j = max(pair % 3, (pair + 1) % 3);
        let p = left[i];
        let q = left[j];
        let v = right[i];
        let w = right[j];
        let by = turn(p, q);
        left[i] = p * by.x - q * by.y;
        left[j] = p * by.y + q * by.x;
        right[i] = v * by.x - w * by.y;
        right[j] = v * by.y + w * by.x;
        pair += 1;
    }
    // what has no length, or one lost in rounding, has no direction: any that is across the others does
    let a = left[0];
    let b = left[1];
    var u = vec3<f32>(1.0, 0.0, 0.0);
    if (dot(a, a) > 0.0) {
        u = normalize(a);
    }
    var v = across(u);
    let beside = b - u * dot(u, b);
    if (dot(beside, beside) > 1e-20 * dot(a, a)) {
        v = normalize(beside);
    }
    let w = cross(u, v);
    return Decomposition(mat3x3<f32>(u, v, w), right, vec3<f32>(dot(u, a), dot(v, b), dot(w, left[2])));
}

// Cosine and sine of the turn after which two columns stand across each other, the longer one first.
fn turn(p: vec3<f32>, q: vec3<f32>) -> vec2<f32> {
    let pp = dot(p, p);
    let pq = dot(p, q);
    let qq = dot(q, q);
    let size = abs(qq - pp) + sqrt((qq - pp) * (qq - pp) + 4.0 * pq * pq);
    var tangent = 0.0;
    if (size > 0.0) {
        tangent = select(2.0, -2.0, qq < pp) * pq / size;
    }
    let cosine = 1.0 / sqrt(1.0 + tangent * tangent);
    let sine = cosine * tangent;
    if (pp - tangent * pq < qq + tangent * pq) {
        return vec2<f32>(sine, -cosine);
    }
    return vec2<f32>(cosine, sine);
}

// A unit vector across another.
fn across(a: vec3<f32>) -> vec3<f32> {
    let axis = vec3<f32>(select(0.0, 1.0, abs(a.x) < 0.6), select(1.0, 0.0, abs(a.x) < 0.6), 0.0);
    return normalize(cross(a, axis));
}

// `U diag(g) V^T`.
fn compose(d: Decomposition, g: vec3<f32>) -> mat3x3<f32> {
    return mat3x3<f32>(d.left[0] * g.x, d.left[1] * g.y, d.left[2] * g.z) * transpose(d.right);
}

// `diag(U^T A V)`: how fast the stretches grow along `A`.
fn stretch_rates(d: Decomposition, along: mat3x3<f32>) -> vec3<f32> {
    let turned = along * d.right;
    return vec3<f32>(dot(d.left[0], turned[0]), dot(d.left[1], turned[1]), dot(d.left[2], turned[2]));
}

// The differential of `U diag(g) V^T` along `A`, with that of `g`: `U D V^T`, where the even part of `M = U^T A V` outside the diagonal is
// multiplied by `(g_i - g_j)/(s_i - s_j)` and the odd one by `(g_i + g_j)/(s_i + s_j)`. `limits` are what the first tends to where two
// stretches coincide, of the first and second, the second and third, the third and first. It has no value where two stretches vanish or
// are opposite: rotations jump there.
fn compose_differential(
    d: Decomposition,
    g: vec3<f32>,
    dg: vec3<f32>,
    limits: vec3<f32>,
    along: mat3x3<f32>,
) -> mat3x3<f32> {
    let s = d.stretches;
    let m = transpose(d.left) * (along * d.right);
    let first = outside(s.x, s.y, g.x, g.y, limits.x, m[1].x, m[0].y);
    let second = outside(s.y, s.z, g.y, g.z, limits.y, m[2].y, m[1].z);
    let third = outside(s.z, s.x, g.z, g.x, limits.z, m[0].z, m[2].x);
    let x = vec3<f32>(dg.x, first.y, third.x);
    let y = vec3<f32>(first.x, dg.y, second.y);
    let z = vec3<f32>(third.y, second.x, dg.z);
    return d.left * (mat3x3<f32>(x, y, z) * transpose(d.right));
}

// Two numbers of `D` across the diagonal from those of `M`.
fn outside(
    si: f32,
    sj: f32,
    gi: f32,
    gj: f32,
    limit: f32,
    mij: f32,
    mji: f32,
) -> vec2<f32> {
    var stretch = limit;
    // nearer to each other a quotient loses more digits than its limit is off
    if (abs(si - sj) >= 2e-3 * (abs(si) + abs(sj))) {
        stretch = (gi - gj) / (si - sj);
    }
    let even = 0.5 * stretch * (mij + mji);
    let odd = 0.5 * (gi + gj) / (si + sj) * (mij - mji);
    return vec2<f32>(even + odd, even - odd);
}
