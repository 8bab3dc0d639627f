//! Marc Lehmann's LZF, which PCD compresses with: literals and back references.

/// Unpacks `packed` to exactly `length` bytes; otherwise the offset where it goes wrong, and why.
///
/// One packed byte makes at most 88, so the output never outgrows its input by more.
pub(super) fn unpack(packed: &[u8], length: usize) -> Result<Vec<u8>, (usize, &'static str)> {
    let mut out: Vec<u8> = Vec::with_capacity(length.min(packed.len().saturating_mul(88)));
    let mut at = 0;
    while at < packed.len() {
        let start = at;
        let control = usize::from(packed[at]);
        at += 1;
        if control < 32 {
            let literals = packed
                .get(at..at + control + 1)
                .ok_or((start, "a run of literals goes beyond the end"))?;
            out.extend_from_slice(literals);
            at += control + 1;
        } else {
            let mut byte = || {
                let value = packed.get(at).copied().map(usize::from);
                at += 1;
                value.ok_or((start, "a back reference is cut off"))
            };
            let mut count = control >> 5;
            if count == 7 {
                count += byte()?;
            }
            let distance = ((control & 31) << 8) + byte()? + 1;
            let from = out
                .len()
                .checked_sub(distance)
                .ok_or((start, "a back reference points before the start"))?;
            // The source may overlap what is being written.
            for k in from..from + count + 2 {
                out.push(out[k]);
            }
        }
        if out.len() > length {
            return Err((start, "there is more data than promised"));
        }
    }
    if out.len() == length {
        Ok(out)
    } else {
        Err((packed.len(), "there is less data than promised"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn literals_and_overlapping_references() {
        // "ab", then eight bytes from two back.
        let packed = [1, b'a', b'b', 6 << 5, 1];
        assert_eq!(unpack(&packed, 10).unwrap(), b"ababababab");
        // A long reference: 7 + 3 + 2 bytes from one back.
        let packed = [0, b'x', 7 << 5, 3, 0];
        assert_eq!(unpack(&packed, 13).unwrap(), b"xxxxxxxxxxxxx");
    }

    #[test]
    fn damage_is_found() {
        assert_eq!(unpack(&[5, b'a'], 6).unwrap_err().0, 0);
        assert_eq!(unpack(&[0, b'a', 1 << 5, 9], 4).unwrap_err().0, 2);
        assert_eq!(unpack(&[0, b'a', 1 << 5], 4).unwrap_err().0, 2);
        assert!(unpack(&[0, b'a'], 2).is_err());
        assert!(unpack(&[1, b'a', b'b'], 1).is_err());
    }
}
