/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "fpga_lens.h"
#include "lens.h"
#include "optics/lens_profile.h"

#include <memory>
#include <vector>

namespace dff {

/* A liquid lens in the hands of the sweep sequencer in the FPGA: the sweep of a plan, by a profile. */
class FpgaSweepLens : public SequencedLens {
public:
    /* Throws I2cError if the slave is something else. */
    FpgaSweepLens(std::unique_ptr<I2cBus> bus, LensProfile profile);

    /* Loads the table of the sweep. An exposure of 0 is the longest that leaves the lens its time, but
     * half a period at least. */
    void prepare(const LensSweep &sweep) override;
    void start() override;
    void stop() override;
    bool calibrated() const override { return true; }
    int code(unsigned plane) const override;
    void check() override;
    std::uint32_t sweep_count() override;
    std::uint32_t frame_count() override;

private:
    std::unique_ptr<I2cBus> bus_;
    LensProfile profile_;
    FpgaLens sequencer_;
    std::vector<PlaneStep> steps_;
    bool gated_ = false;
};

/* What the lens is told for each plane of a plan: what the profile says, and before each a first code that
 * goes beyond it by the profile's overdrive, as far as the driver can. Throws std::invalid_argument. */
std::vector<PlaneStep> plane_steps(const SweepPlan &plan, const LensProfile &profile);

} // namespace dff
