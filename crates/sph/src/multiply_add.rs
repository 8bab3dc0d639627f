//! Fused multiplication and addition where the processor has the instruction.

use pulp::Simd;

/// a·b + c, rounded once on processors with vectors and twice on others.
///
/// Every processor for which pulp has vectors also has the fused instruction. On other processors
/// `f64::mul_add` would be a slow library call.
#[inline(always)]
pub(crate) fn multiply_add<S: Simd>(a: f64, b: f64, c: f64) -> f64 {
    if size_of::<S::f64s>() > size_of::<f64>() {
        a.mul_add(b, c)
    } else {
        a * b + c
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ways_agree_to_rounding() {
        let plain = multiply_add::<pulp::Scalar>(1.0 / 3.0, 0.7, -0.1);
        let once = (1.0_f64 / 3.0).mul_add(0.7, -0.1);
        assert!((plain - once).abs() <= 1e-16);
    }
}
