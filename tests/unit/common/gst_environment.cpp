/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include <gst/gst.h>
#include <gtest/gtest.h>

/* Linking this in calls gst_init() before the first test. */
namespace {

class GStreamerEnvironment : public testing::Environment {
public:
    void SetUp() override { gst_init(nullptr, nullptr); }
};

[[maybe_unused]] testing::Environment *const environment =
    testing::AddGlobalTestEnvironment(new GStreamerEnvironment);

} // namespace
