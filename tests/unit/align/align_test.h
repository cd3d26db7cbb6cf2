/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "../focalstack/support.h"
#include "shaken_stack.h"

#include <gtest/gtest.h>

/* How the stacks of these tests are taken: small, with four planes. */
constexpr unsigned planes = 4;
constexpr unsigned middle = 2;
inline const Shaking shaking{.size = {151, 117}, .planes = planes, .jitter = 2.0, .blur_step = 0.5};

GstFocalStackInfo stack_info(const char *format, cv::Size size, unsigned count = planes);

/* A stack in the default layout; every colour channel shows the pictures, chroma at half their size. */
GstBuffer *new_stack(const GstFocalStackInfo &info, const std::vector<cv::Mat> &pictures);

/* What `stats` tells. */
struct PlaneStats {
    double dx = 0.0, dy = 0.0, scale = 0.0, rotation = 0.0;
    double perspective = 0.0; /* the first number of the matrix's last row */
    gboolean trusted = FALSE;
};
std::vector<PlaneStats> planes_of(const GstStructure *stats);
guint64 number_of(const GstStructure *stats, const char *name);

/* The element with stacks of one format going in. */
class FocalStackAlign : public testing::Test {
protected:
    /* `wants_place`: downstream asks where each stack lies. */
    void start(const GstFocalStackInfo &info, bool wants_place = false);
    void TearDown() override;

    Owned<GstBuffer> align(GstBuffer *stack);
    Owned<GstStructure> stats() const;
    std::string last_error() const;

    /* How alike a plane and the middle plane are, by their normalised correlation away from the border. */
    double likeness(GstBuffer *stack, unsigned z, unsigned channel) const;

    /* The mean of a plane's channel. */
    double brightness(GstBuffer *stack, unsigned z, unsigned channel) const;

    GstFocalStackInfo info_{};
    Owned<GstHarness> harness_;
    GstBus *bus_ = nullptr;
};
