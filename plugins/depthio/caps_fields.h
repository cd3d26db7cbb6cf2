/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/gst.h>

namespace dff {

/* A copy of `caps` in another format, without the fields that speak of the old one's colours and of depth;
 * only what `filter` allows, if there is one. */
GstCaps *caps_in_format(const GstCaps *caps, const char *format, GstCaps *filter);

} // namespace dff
