//! Small upper triangular matrices on the stack, for a square-root filter. Nothing here allocates.

/// Rows of an upper triangular matrix; entries below the diagonal are zero.
pub(super) type Square<const P: usize> = [[f64; P]; P];

/// Solves R x = z.
pub(super) fn back<const P: usize>(root: &Square<P>, z: &[f64; P]) -> [f64; P] {
    let mut x = [0.0; P];
    for i in (0..P).rev() {
        let rest: f64 = (i + 1..P).map(|j| root[i][j] * x[j]).sum();
        x[i] = (z[i] - rest) / root[i][i];
    }
    x
}

/// Solves Rᵀ y = x.
pub(super) fn forward<const P: usize>(root: &Square<P>, x: &[f64; P]) -> [f64; P] {
    let mut y = [0.0; P];
    for i in 0..P {
        let rest: f64 = (0..i).map(|j| root[j][i] * y[j]).sum();
        y[i] = (x[i] - rest) / root[i][i];
    }
    y
}

/// Rotates a row (x, y) into (R, z): `RᵀR` grows by x xᵀ (Givens rotations; Golub & Van Loan, §6.5).
pub(super) fn rotate_in<const P: usize>(root: &mut Square<P>, z: &mut [f64; P], mut x: [f64; P], mut y: f64) {
    for i in 0..P {
        if x[i] == 0.0 {
            continue;
        }
        let length = root[i][i].hypot(x[i]);
        let (c, s) = (root[i][i] / length, x[i] / length);
        for j in i..P {
            (root[i][j], x[j]) = (c * root[i][j] + s * x[j], c * x[j] - s * root[i][j]);
        }
        (z[i], y) = (c * z[i] + s * y, c * y - s * z[i]);
    }
}

/// Makes a full square (R, z) upper triangular again without changing `RᵀR` and `Rᵀz`.
pub(super) fn triangularise<const P: usize>(full: &Square<P>, z: &[f64; P]) -> (Square<P>, [f64; P]) {
    let (mut root, mut rotated) = ([[0.0; P]; P], [0.0; P]);
    for (row, value) in full.iter().zip(z) {
        rotate_in(&mut root, &mut rotated, *row, *value);
    }
    // Diagonals positive, so that logarithms and signs of others mean something.
    for i in 0..P {
        if root[i][i] < 0.0 {
            root[i].iter_mut().for_each(|r| *r = -*r);
            rotated[i] = -rotated[i];
        }
    }
    (root, rotated)
}

/// `(RᵀR)⁻¹ x`.
pub(super) fn inverse_times<const P: usize>(root: &Square<P>, x: &[f64; P]) -> [f64; P] {
    back(root, &forward(root, x))
}

/// xᵀ M y.
pub(super) fn between<const P: usize>(x: &[f64; P], matrix: &Square<P>, y: &[f64; P]) -> f64 {
    x.iter().zip(matrix).map(|(x, row)| x * dot(row, y)).sum()
}

pub(super) fn dot<const P: usize>(a: &[f64; P], b: &[f64; P]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
