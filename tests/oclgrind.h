/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Stands before every kernel file in oclgrind.sh: what the simulator does not know. */
/* Functions that return structures stay calls; inlined, they copy by functions of LLVM. */
#define INLINE inline
#define PREFETCH(address)
