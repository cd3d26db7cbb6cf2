/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Stands before every kernel file in oclgrind.sh: what the simulator does not know. */
/* Functions that return structures stay calls; inlined, they copy by functions of LLVM. */
#define INLINE inline
#define PREFETCH(address)

/* `next` makes the result of all lanes up to lanes[i]. */
#define REDUCE(v, result, next)                                                                              \
    ({                                                                                                       \
        __typeof__(v) lanes = (v);                                                                           \
        int result = lanes[0];                                                                               \
        for (int i = 1; i < (int)(sizeof(lanes) / sizeof(lanes[0])); i++)                                    \
            result = next;                                                                                   \
        result;                                                                                              \
    })
#define __builtin_reduce_min(v) REDUCE(v, least, min(least, (int)lanes[i]))
#define __builtin_reduce_max(v) REDUCE(v, most, max(most, (int)lanes[i]))
#define __builtin_reduce_or(v) REDUCE(v, bits, bits | lanes[i])
