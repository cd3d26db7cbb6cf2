/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/gst.h>
#include <vector>

namespace dff {

/* Gives a bin's class the writable properties of its children's `types`, each name once, with ids from
 * `first_id` on. */
void install_forwarded_properties(GObjectClass *bin_class, guint first_id, const std::vector<GType> &types);

/* Sets it on each of the children that has it. */
void set_forwarded_property(const std::vector<GstElement *> &children, const GValue *value,
                            const GParamSpec *spec);

/* Gets it from the first child that has it. */
void get_forwarded_property(const std::vector<GstElement *> &children, GValue *value, const GParamSpec *spec);

} // namespace dff
