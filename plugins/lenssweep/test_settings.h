/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "sweep_properties.h"
#include "test_scene.h"

#include <glib-object.h>

/* The properties of lenssweeptestsrc. */
struct TestSettings {
    SweepProperties sweep;
    gdouble rate = 26.0;
    TestScene scene;
    gboolean is_live = FALSE;
    gint num_buffers = -1;
};

void install_test_properties(GObjectClass *klass);

/* False if there is no property of this id. */
bool set_test_property(TestSettings &settings, guint id, const GValue *value);
bool get_test_property(const TestSettings &settings, guint id, GValue *value);
