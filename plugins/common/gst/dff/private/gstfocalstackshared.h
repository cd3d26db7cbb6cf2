/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "../gstfocalstackmeta.h"

G_BEGIN_DECLS

/* What elements that have the same stack make of its memory together; it ends with the last buffer that has
 * that memory. */
typedef struct {
    GMutex mutex; /* guards the rest */
    gpointer data;
    GDestroyNotify destroy;
} GstFocalStackShared;

/* Under the mutex: takes the place of what was there. */
GST_DFF_API void gst_focal_stack_shared_set(GstFocalStackShared *shared, gpointer data,
                                            GDestroyNotify destroy);

G_END_DECLS
