//! The order in which integer powers are multiplied out.

/// `base` multiplied by itself, by squaring from the exponent's lowest bit up: x⁶ = x²·x⁴. `None` when the exponent is zero.
///
/// This order is the definition of the power's value, which whoever writes the products out must follow. `multiply` gives the product of
/// both, or the square of the first.
#[inline]
pub fn by_squaring<T: Copy>(
    base: T,
    exponent: u32,
    mut multiply: impl FnMut(T, Option<T>) -> T,
) -> Option<T> {
    let (mut square, mut product) = (base, None);
    for bit in 0..u32::BITS - exponent.leading_zeros() {
        if bit > 0 {
            square = multiply(square, None);
        }
        if exponent >> bit & 1 == 1 {
            product = Some(product.map_or(square, |product| multiply(product, Some(square))));
        }
    }
    product
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_come_in_the_order_that_is_said() {
        for (exponent, expected) in
            [(1, "x"), (2, "(x²)"), (3, "x·(x²)"), (6, "(x²)·((x²)²)"), (7, "x·(x²)·((x²)²)")]
        {
            // Texts are no copies; their places are.
            let mut texts = vec!["x".to_owned()];
            let place = by_squaring(0, exponent, |a: usize, b| {
                let text =
                    b.map_or_else(|| format!("({}²)", texts[a]), |b| format!("{}·{}", texts[a], texts[b]));
                texts.push(text);
                texts.len() - 1
            });
            assert_eq!(texts[place.unwrap()], expected);
        }
        assert_eq!(by_squaring(2, 0, |a, _| a), None);
        let count = (1..500).all(|exponent| {
            by_squaring(1_u64, exponent, |a, b| a + b.unwrap_or(a)) == Some(u64::from(exponent))
        });
        assert!(count, "exponents add up");
    }
}
