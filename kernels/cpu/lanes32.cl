/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * 32 lanes of 16 bits: one register of AVX-512, two of AVX2. Vectors of 32 are clang's, on which the drivers of CPUs
 * are built; OpenCL's own end at 16.
 */

/* Compilers for CPUs need to be told; what they leave as a call they split to half the lanes. */
#ifndef INLINE /* a simulator may know better */
#define INLINE inline __attribute__((always_inline))
#endif

typedef uchar uchar32 __attribute__((ext_vector_type(32)));
typedef short short32 __attribute__((ext_vector_type(32)));
typedef ushort ushort32 __attribute__((ext_vector_type(32)));
typedef uchar uchar64 __attribute__((ext_vector_type(64)));

/* That may lie anywhere in memory. */
typedef uchar32 __attribute__((aligned(1))) bytes32;
typedef uchar64 __attribute__((aligned(1))) bytes64;
typedef short32 __attribute__((aligned(2))) slanes32;
typedef ushort32 __attribute__((aligned(2))) lanes32;

#define as_short32(v) __builtin_astype(v, short32)
#define as_ushort32(v) __builtin_astype(v, ushort32)

inline short32 higher(short32 a, short32 b)
{
    return a > b ? a : b;
}

inline short32 lower(short32 a, short32 b)
{
    return a < b ? a : b;
}

inline ushort32 min32(ushort32 a, ushort32 b)
{
    return a < b ? a : b;
}

inline ushort32 max32(ushort32 a, ushort32 b)
{
    return a > b ? a : b;
}

inline ushort32 widen(uchar32 v)
{
    return __builtin_convertvector(v, ushort32);
}

inline ushort16 first_half(ushort32 v)
{
    return __builtin_shufflevector(v, v, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}

inline ushort16 second_half(ushort32 v)
{
    return __builtin_shufflevector(v, v, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31);
}

typedef uint __attribute__((ext_vector_type(32))) wide32;

inline wide32 as_wide(ushort32 v)
{
    return __builtin_convertvector(v, wide32);
}

/* a b / 65536, rounded down. Compilers know it as one instruction, but do not see it in a loop with the same b. */
INLINE ushort32 part_of(ushort32 a, ushort32 b)
{
#if defined __AVX512BW__
    return as_ushort32(__builtin_ia32_pmulhuw512(as_short32(a), as_short32(b)));
#elif defined __AVX2__
    const short16 low = __builtin_ia32_pmulhuw256(as_short16(first_half(a)), as_short16(first_half(b)));
    const short16 high = __builtin_ia32_pmulhuw256(as_short16(second_half(a)), as_short16(second_half(b)));
    return as_ushort32((short32)(low, high));
#else
    return __builtin_convertvector((as_wide(a) * as_wide(b)) >> 16u, ushort32);
#endif
}

INLINE float sum_of_lanes(float16 v)
{
    const float8 a = v.lo + v.hi;
    const float4 b = a.lo + a.hi;
    const float2 c = b.lo + b.hi;
    return c.lo + c.hi;
}

/* The least lane of a vector, the greatest one, whether any is not 0, and the sum of bytes. */
#ifdef __SPIR__ /* a simulator, which knows none of the built-ins */
#define REDUCTION(name, vector, scalar, lanes, operation)                                                              \
    inline scalar __attribute__((overloadable)) name(vector v)                                                         \
    {                                                                                                                  \
        scalar all = v[0];                                                                                             \
        for (int i = 1; i < lanes; i++)                                                                                \
            all = operation;                                                                                           \
        return all;                                                                                                    \
    }
REDUCTION(least_of, uchar16, uchar, 16, min(all, v[i]))
REDUCTION(least_of, ushort16, ushort, 16, min(all, v[i]))
REDUCTION(least_of, ushort32, ushort, 32, min(all, v[i]))
REDUCTION(least_of, uchar64, uchar, 64, min(all, v[i]))
REDUCTION(most_of, uchar16, uchar, 16, max(all, v[i]))
REDUCTION(most_of, ushort16, ushort, 16, max(all, v[i]))
REDUCTION(most_of, ushort32, ushort, 32, max(all, v[i]))
REDUCTION(most_of, uchar64, uchar, 64, max(all, v[i]))
REDUCTION(any_of, short32, int, 32, all | v[i])
REDUCTION(sum_of_bytes, uchar64, uint, 64, all + v[i])
#else
typedef uint __attribute__((ext_vector_type(64))) wide64;
#define least_of(v) __builtin_reduce_min(v)
#define most_of(v) __builtin_reduce_max(v)
#define any_of(v) (__builtin_reduce_or(v) != 0)
#define sum_of_bytes(v) __builtin_reduce_add(__builtin_convertvector(v, wide64))
#endif

typedef ushort32 __attribute__((aligned(1))) byte_pairs; /* of 64 columns: even | odd << 8 */

inline ushort32 even_bytes(ushort32 pairs)
{
    return pairs & (ushort)255;
}

inline ushort32 odd_bytes(ushort32 pairs)
{
    return pairs >> (ushort)8;
}

inline float16 even_lanes(ushort32 v)
{
    return convert_float16(as_int16(v) & 65535);
}

inline float16 odd_lanes(ushort32 v)
{
    return convert_float16(as_int16(as_uint16(v) >> 16));
}

/* Asks for the cache line of an address that will be read soon; OpenCL's own prefetch() does nothing on CPUs. (Pointers
 * of two address spaces convert through integers only.) */
#ifndef PREFETCH
#define PREFETCH(address) __builtin_prefetch((const void *)(ulong)(address))
#endif

/* Runs over 32 samples or more as FOR_EACH_16 does over 16. */
#define FOR_EACH_32(x, width) for (int x = 0; x < (width); x = x + 32 < (width) ? min(x + 32, (width) - 32) : (width))
