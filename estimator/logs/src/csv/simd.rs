//! Plain numbers with vector instructions. The 32 characters before a cell's end become an integer in a dozen steps,
//! whatever the number's length. The decimal point becomes one division, corrected by its remainder.
//!
//! Anything but `-`, digits and at most one decimal point, and any number that cannot be rounded with certainty, is
//! left to the careful parser: results are those of `str::parse::<f64>` to the bit. Only processors with AVX2 and FMA
//! come here; others parse everything carefully.

use std::arch::x86_64::{
    __m256d, __m256i, _CMP_EQ_OQ, _CMP_NLT_UQ, _mm_madd_epi16, _mm_packus_epi32, _mm_set1_epi32, _mm256_add_epi8,
    _mm256_add_epi64, _mm256_add_pd, _mm256_and_pd, _mm256_and_si256, _mm256_blendv_epi8, _mm256_blendv_pd,
    _mm256_castpd_si256, _mm256_castsi256_pd, _mm256_castsi256_si128, _mm256_cmp_pd, _mm256_cmpeq_epi8,
    _mm256_cmpeq_epi64, _mm256_div_pd, _mm256_extracti128_si256, _mm256_fmadd_pd, _mm256_fnmadd_pd, _mm256_madd_epi16,
    _mm256_maddubs_epi16, _mm256_max_epu8, _mm256_movemask_epi8, _mm256_movemask_pd, _mm256_mul_epu32, _mm256_mul_pd,
    _mm256_or_si256, _mm256_permute2f128_pd, _mm256_set1_epi8, _mm256_set1_epi16, _mm256_set1_epi32,
    _mm256_set1_epi64x, _mm256_set1_pd, _mm256_setzero_si256, _mm256_slli_epi64, _mm256_srli_epi64, _mm256_sub_pd,
    _mm256_unpackhi_pd, _mm256_unpacklo_pd,
};

/// Characters that are looked at: a longer cell is no plain number.
const WINDOW: usize = 32;
/// `WINDOW` with the character before it, and the mark behind.
pub const REACH: usize = WINDOW + 2;

/// 10⁰ … 10²², all exact, and their inverses, rounded.
static TENS: [[f64; 2]; 23] = [
    [1e0, 1e-0],
    [1e1, 1e-1],
    [1e2, 1e-2],
    [1e3, 1e-3],
    [1e4, 1e-4],
    [1e5, 1e-5],
    [1e6, 1e-6],
    [1e7, 1e-7],
    [1e8, 1e-8],
    [1e9, 1e-9],
    [1e10, 1e-10],
    [1e11, 1e-11],
    [1e12, 1e-12],
    [1e13, 1e-13],
    [1e14, 1e-14],
    [1e15, 1e-15],
    [1e16, 1e-16],
    [1e17, 1e-17],
    [1e18, 1e-18],
    [1e19, 1e-19],
    [1e20, 1e-20],
    [1e21, 1e-21],
    [1e22, 1e-22],
];

/// Nothing and everything: from byte n on, a mask for the last n of 32 bytes.
#[repr(align(64))]
struct Edge([u8; 2 * WINDOW]);

static EDGE: Edge = {
    let mut edge = [0; 2 * WINDOW];
    let mut i = WINDOW;
    while i < 2 * WINDOW {
        edge[i] = 0xff;
        i += 1;
    }
    Edge(edge)
};

/// True if the processor has the features that the functions here are compiled with.
pub fn is_at_home() -> bool {
    use std::arch::is_x86_feature_detected as has;
    has!("avx2") && has!("bmi1") && has!("bmi2") && has!("lzcnt") && has!("popcnt") && has!("fma")
}

/// A mask for all but the first `32 − count` of 32 bytes; `None` for more than 32.
#[inline]
#[target_feature(enable = "avx2")]
fn last(count: usize) -> Option<__m256i> {
    EDGE.0.get(count..)?.first_chunk::<WINDOW>().map(|mask| bytemuck::must_cast(*mask))
}

/// The same; `None` for nothing, too.
#[inline]
#[target_feature(enable = "avx2")]
fn last_some(count: usize) -> Option<__m256i> {
    EDGE.0[1..].get(count.wrapping_sub(1)..)?.first_chunk::<WINDOW>().map(|mask| bytemuck::must_cast(*mask))
}

/// Appends the indices of all delimiters and line ends in `bytes`.
#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
pub fn find_ends(bytes: &[u8], delimiter: u8, ends: &mut Vec<u32>) {
    const BLOCK: usize = 2 * WINDOW;
    let (delimiters, line_ends) = (_mm256_set1_epi8(delimiter.cast_signed()), _mm256_set1_epi8(b'\n'.cast_signed()));
    let (blocks, rest) = bytes.as_chunks::<BLOCK>();
    let found = |half: [u8; WINDOW]| {
        let half = bytemuck::must_cast(half);
        let both = _mm256_or_si256(_mm256_cmpeq_epi8(half, delimiters), _mm256_cmpeq_epi8(half, line_ends));
        u64::from(_mm256_movemask_epi8(both).cast_unsigned())
    };
    let mut count = ends.len();
    for (i, block) in blocks.iter().enumerate() {
        if ends.len() < count + BLOCK {
            ends.resize(2 * count + 16 * BLOCK, 0);
        }
        let Some(slots) = ends[count..].first_chunk_mut::<BLOCK>() else { break };
        let [first, second]: [[u8; WINDOW]; 2] = bytemuck::must_cast(*block);
        let mut bits = found(first) | found(second) << WINDOW;
        count += bits.count_ones() as usize;
        let base = (i * BLOCK) as u32;
        // Four at a time, needed or not: cheaper than to ask after each.
        for four in slots.as_chunks_mut::<4>().0 {
            for slot in four {
                *slot = base + bits.trailing_zeros();
                bits &= bits.wrapping_sub(1);
            }
            if bits == 0 {
                break;
            }
        }
    }
    ends.truncate(count);
    let start = bytes.len() - rest.len();
    let found = rest.iter().enumerate().filter(|&(_, &b)| b == delimiter || b == b'\n');
    ends.extend(found.map(|(i, _)| (start + i) as u32));
}

/// The largest digit that was met in a row: whether all were digits is asked for once.
#[derive(Clone, Copy, Debug)]
pub struct Digits(__m256i);

impl Digits {
    #[inline]
    #[target_feature(enable = "avx2")]
    pub fn none() -> Self {
        Self(_mm256_setzero_si256())
    }

    /// True when nothing else than digits was met.
    #[inline]
    #[target_feature(enable = "avx2")]
    pub fn only(self) -> bool {
        let nine = _mm256_set1_epi8(9);
        _mm256_movemask_epi8(_mm256_cmpeq_epi8(_mm256_max_epu8(self.0, nine), nine)) == -1
    }
}

/// A number as it was written: the bits of its digits, eight by eight, the lowest last; then the power of ten by which they are
/// divided, and its inverse.
pub type Written = [f64; 4];

/// 0.
pub const ZERO: Written = [0.0, 0.0, 1.0, 1.0];

/// The number of a cell of `length` characters, which ends one before the end of `around`, and its sign bit. `None` if
/// another parser must look at it; worthless if `met` was not only digits. `COMMA`: a decimal comma counts too.
#[inline]
#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt,fma")]
pub fn number<const COMMA: bool>(around: &[u8; REACH], length: usize, met: &mut Digits) -> Option<(Written, u64)> {
    let negative = *around.get((REACH - 1).wrapping_sub(length))? == b'-';
    let characters = length - usize::from(negative);
    // The digits end the window; the one that ends a character earlier has those before the point where they belong.
    let [_, digits @ .., _] = *around;
    let [moved @ .., _, _] = *around;
    let (digits, moved): (__m256i, __m256i) = (bytemuck::must_cast(digits), bytemuck::must_cast(moved));
    let mut points = _mm256_cmpeq_epi8(digits, _mm256_set1_epi8(b'.'.cast_signed()));
    if COMMA {
        points = _mm256_or_si256(points, _mm256_cmpeq_epi8(digits, _mm256_set1_epi8(b','.cast_signed())));
    }
    // Characters behind the last point, which may be another cell's. A second point in this cell is no digit.
    let behind = _mm256_movemask_epi8(points).cast_unsigned().leading_zeros() as usize;
    let pointed = behind < characters;
    let kept = last_some(characters - usize::from(pointed))?;
    let joined = _mm256_blendv_epi8(moved, digits, last(behind)?);
    let values = _mm256_and_si256(_mm256_add_epi8(joined, _mm256_set1_epi8(-(b'0'.cast_signed()))), kept);
    met.0 = _mm256_max_epu8(met.0, values);
    let pairs = _mm256_maddubs_epi16(values, _mm256_set1_epi16(0x010a));
    let fours = _mm256_madd_epi16(pairs, _mm256_set1_epi32(0x0001_0064));
    let packed = _mm_packus_epi32(_mm256_castsi256_si128(fours), _mm256_extracti128_si256::<1>(fours));
    let [front, back] = bytemuck::must_cast::<_, [f64; 2]>(_mm_madd_epi16(packed, _mm_set1_epi32(0x0001_2710)));
    let [ten, tenth] = *TENS.get(if pointed { behind } else { 0 })?;
    Some(([front, back, ten, tenth], u64::from(negative) << 63))
}

/// Values of `written`, each rounded once by division and once by its factor; NaN if the first is not certain. True if
/// all are.
#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt,fma")]
pub fn quotients(written: &[[Written; 4]], factors: &[[f64; 4]], values: &mut [[f64; 4]]) -> bool {
    let mut certain = _mm256_castsi256_pd(_mm256_set1_epi8(-1));
    for ((values, written), factors) in values.iter_mut().zip(written).zip(factors) {
        let (sizes, good) = quotients_of_four(written);
        certain = _mm256_and_pd(certain, good);
        let scaled = _mm256_mul_pd(sizes, bytemuck::must_cast(*factors));
        *values = bytemuck::must_cast(_mm256_blendv_pd(_mm256_set1_pd(f64::NAN), scaled, good));
    }
    _mm256_movemask_pd(certain) == 0b1111
}

/// Four quotients, and which of them are certain.
#[inline]
#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt,fma")]
fn quotients_of_four(written: &[Written; 4]) -> (__m256d, __m256d) {
    const EXACT: f64 = 9_007_199_254_740_992.0;
    // The sum, product and inverse below are each off by 2⁻⁵³ at most.
    const OFF: f64 = 4.0 * f64::EPSILON;
    let [fronts, backs, tens, tenths] = transposed(written);
    let (fronts, backs) = (_mm256_castpd_si256(fronts), _mm256_castpd_si256(backs));
    let low = |v| _mm256_and_si256(v, _mm256_set1_epi64x(0xffff_ffff));
    let high = |v| _mm256_srli_epi64::<32>(v);
    // 10⁸·(10⁸·second eight + third) + fourth, while the first is 0 and the second below 1024: 19 digits and a bit.
    let eight = |v| _mm256_mul_epu32(v, _mm256_set1_epi64x(100_000_000));
    let upper = _mm256_add_epi64(eight(high(fronts)), low(backs));
    let carried = _mm256_slli_epi64::<32>(eight(high(upper)));
    let integers = _mm256_add_epi64(_mm256_add_epi64(eight(upper), carried), high(backs));
    let over = _mm256_or_si256(low(fronts), _mm256_srli_epi64::<42>(fronts));
    let fits = _mm256_cmpeq_epi64(over, _mm256_setzero_si256());
    // Both halves as doubles: behind the bits of 2⁸⁴ and 2⁵².
    let double = |v, behind: f64| {
        let placed = _mm256_or_si256(v, _mm256_set1_epi64x(behind.to_bits().cast_signed()));
        _mm256_sub_pd(_mm256_castsi256_pd(placed), _mm256_set1_pd(behind))
    };
    let (upper, lower) = (double(high(integers), 2_f64.powi(84)), double(low(integers), 2_f64.powi(52)));
    let near = _mm256_add_pd(upper, lower);
    let quotient = _mm256_div_pd(near, tens);
    let fits = _mm256_castsi256_pd(fits);
    // Both exact: one division rounds once (Clinger 1990).
    if _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_NLT_UQ>(near, _mm256_set1_pd(EXACT))) == 0 {
        return (quotient, fits);
    }
    // Remainders of sum and division: all differences are exact, and the true quotient is `quotient` + rest/ten.
    let lost = _mm256_sub_pd(lower, _mm256_sub_pd(near, upper));
    let missing = _mm256_mul_pd(_mm256_add_pd(_mm256_fnmadd_pd(quotient, tens, near), lost), tenths);
    // Rounding is monotonic: where both bounds round to the same, so does the true quotient.
    let least = _mm256_fmadd_pd(missing, _mm256_set1_pd(1.0 - OFF), quotient);
    let most = _mm256_fmadd_pd(missing, _mm256_set1_pd(1.0 + OFF), quotient);
    (least, _mm256_and_pd(_mm256_cmp_pd::<_CMP_EQ_OQ>(least, most), fits))
}

#[inline]
#[target_feature(enable = "avx2")]
fn transposed(rows: &[Written; 4]) -> [__m256d; 4] {
    let [a, b, c, d]: [__m256d; 4] = bytemuck::must_cast(*rows);
    let (even, odd) = (_mm256_unpacklo_pd(a, b), _mm256_unpackhi_pd(a, b));
    let (more_even, more_odd) = (_mm256_unpacklo_pd(c, d), _mm256_unpackhi_pd(c, d));
    [
        _mm256_permute2f128_pd::<0x20>(even, more_even),
        _mm256_permute2f128_pd::<0x20>(odd, more_odd),
        _mm256_permute2f128_pd::<0x31>(even, more_even),
        _mm256_permute2f128_pd::<0x31>(odd, more_odd),
    ]
}
