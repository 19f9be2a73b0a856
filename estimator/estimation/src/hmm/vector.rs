//! One function, compiled for several processors: the widest vectors that this one has do the work.
//!
//! The arithmetic is the same in each, operation by operation (nothing is fused), so that results agree to the bit.

/// Defines a function that runs `$body(arguments)`, compiled for AVX-512, for AVX2 and for any processor.
///
/// `$body` must be `#[inline(always)]`, with all that it calls in its loops. A second body, if there is one, is for AVX-512 alone.
macro_rules! for_this_processor {
    ($(#[$about:meta])* $visible:vis fn $name:ident($($argument:ident: $type:ty),* $(,)?) => $body:path) => {
        for_this_processor! { $(#[$about])* $visible fn $name($($argument: $type),*) => $body, $body }
    };
    ($(#[$about:meta])* $visible:vis fn $name:ident($($argument:ident: $type:ty),* $(,)?) => $body:path, $wide:path) => {
        $(#[$about])*
        $visible fn $name($($argument: $type),*) {
            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx512f,avx512dq,avx512vl,avx512bw")]
                fn with_avx512($($argument: $type),*) {
                    $wide($($argument),*);
                }
                #[target_feature(enable = "avx2")]
                fn with_avx2($($argument: $type),*) {
                    $body($($argument),*);
                }
                use std::arch::is_x86_feature_detected as has;
                if has!("avx512f") && has!("avx512dq") && has!("avx512vl") && has!("avx512bw") {
                    // SAFETY: the processor has just been asked for every instruction that the function is compiled with.
                    #[allow(unsafe_code, reason = "the only way to call a function that not every processor can run")]
                    return unsafe { with_avx512($($argument),*) };
                }
                if has!("avx2") {
                    // SAFETY: as above.
                    #[allow(unsafe_code, reason = "the only way to call a function that not every processor can run")]
                    return unsafe { with_avx2($($argument),*) };
                }
            }
            $body($($argument),*);
        }
    };
}

pub(super) use for_this_processor;
