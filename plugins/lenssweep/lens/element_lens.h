/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "lens.h"
#include "lens_property.h"
#include "optics/focus_points.h"

#include <memory>
#include <optional>
#include <vector>

namespace dff {

/* A lens that is moved by a property of an element, such as lens-position of libcamerasrc. The property is in
 * dioptres, or in what the points of a profile say. What it reads is taken for where the lens was told to be
 * for a frame that is done; an element that only repeats what was set says as much at once. Its safe state is
 * where it is, with autofocus as it was. */
class ElementLens : public SteppedLens {
public:
    explicit ElementLens(std::unique_ptr<LensProperty> property, std::optional<FocusPoints> points);
    ~ElementLens() override;

    void prepare(const LensSweep &sweep) override;
    void start() override;
    void stop() override;
    bool calibrated() const override { return true; }

    /* The value of an integer property, else -1. */
    int code(unsigned plane) const override;
    void move_to(unsigned plane) override;
    bool wait_settled(const std::stop_token &stop) override { return !stop.stop_requested(); }

    /* Throws LensError if the property has not arrived after very many frames. */
    std::optional<bool> at_plane() override;
    bool knows_rest() const override { return false; }

private:
    std::unique_ptr<LensProperty> property_;
    std::optional<FocusPoints> points_;
    std::vector<double> positions_; /* one a plane */
    double tolerance_ = 0;
    double target_ = 0;
    unsigned asked_ = 0; /* since the last move */
    bool started_ = false;
};

} // namespace dff
