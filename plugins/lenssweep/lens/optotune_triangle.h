/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "lens.h"
#include "optics/focus_points.h"
#include "optotune_driver.h"

#include <optional>
#include <vector>

namespace dff {

/* A tunable lens of Optotune whose Lens Driver 4 or 4i moves it to and fro by itself, in a triangle. From
 * turn to turn there is a frame for each plane, and the current in the middle of its time is the plane's: so
 * it turns half a plane beyond the nearest and the farthest one. Pin A of the driver rises as the current
 * turns at the near end: the edge of the sync line.
 *
 * The driver's triangle is one of current, so a profile with unit "mA" is needed, and planes that are even in
 * it. The lens follows the current a little later, which the driver does not know. Its safe state is without
 * current. */
class OptotuneTriangle : public SweptLens {
public:
    /* Throws LensError if no driver answers on the port, std::invalid_argument without points in mA. */
    OptotuneTriangle(const std::string &device, const std::optional<FocusPoints> &points);
    ~OptotuneTriangle() override;

    void prepare(const LensSweep &sweep) override;
    void start() override;
    void stop() override;
    bool calibrated() const override { return true; }
    int code(unsigned plane) const override;

    /* Throws LensError if the lens is too hot. */
    void check() override;

    bool goes_to_and_fro() const override { return true; }

private:
    FocusPoints points_;
    OptotuneDriver driver_;
    std::vector<double> currents_; /* mA, one a plane */
    double lower_ = 0;             /* mA, at its turns */
    double upper_ = 0;
    double hertz_ = 0;
};

} // namespace dff
