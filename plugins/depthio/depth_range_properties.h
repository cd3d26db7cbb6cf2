/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/gst.h>

namespace dff {

/* The properties `near` and `far` of elements between depth and colours, in dioptres. */
struct DepthRangeProperties {
    static constexpr double not_set = -1.0;

    double near = not_set;
    double far = not_set;
};

/* Installs `near` under the number `first`, `far` under the next one. `otherwise` says what -1 means, and
 * what else there is to say of both. */
void install_depth_range(GObjectClass *object_class, guint first, const char *otherwise, gint mutability);

/* False for other properties than near and far. */
bool set_depth_range(DepthRangeProperties &range, const GParamSpec *property, const GValue *value);
bool get_depth_range(const DepthRangeProperties &range, const GParamSpec *property, GValue *value);

} // namespace dff
