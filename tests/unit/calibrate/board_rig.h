/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "rig_calibration.h"

namespace dff {

/* The simulated rig that tests calibrate, and what is true of it: 640x480, 6 planes from 3.4 to 0.7 dioptres,
 * 3 % of breathing, half a plane of field curvature, 5 % of vignetting. */
class BoardRig {
public:
    static constexpr double step = 0.54; /* dioptres from plane to plane */

    BoardRig();
    ~BoardRig();
    BoardRig(const BoardRig &) = delete;
    BoardRig &operator=(const BoardRig &) = delete;

    const Board &board() const { return board_; }
    /* Of twelve boards, in the words of lenssweeptestsrc. */
    const std::vector<std::string> &poses() const { return poses_; }
    /* The file of the camera that sees them. */
    const std::string &camera() const { return camera_; }

    /* Vergence within 0.1 planes everywhere, the focal length within 0.3 %, planes within 0.1 pixels. */
    void expect_found(const RigCalibration &found) const;

private:
    Board board_{10, 7, 20.0};
    std::vector<std::string> poses_;
    std::string camera_;
};

} // namespace dff
