/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "gst_pointer.h"

namespace dff {

/* The free source pad of the element called `name`, or a new one if it is a tee, or else the free source pad
 * called `name` of any element in the bin. Null if there is none. */
ObjectPointer<GstPad> find_free_pad(GstBin *bin, const char *name);

} // namespace dff
