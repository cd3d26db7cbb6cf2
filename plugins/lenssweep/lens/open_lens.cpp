/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "open_lens.h"

#include "fpga_sweep_lens.h"
#include "genicam_lens.h"
#include "linux_i2c_bus.h"
#include "max14574_lens.h"
#include "v4l2_lens.h"

#include <cstdlib>
#include <stdexcept>

namespace dff {

namespace {

/* The lens `none`: what it does is nobody's business here. */
class UnmovedLens : public Lens {
public:
    void prepare(const LensSweep &) override {}
    void start() override {}
    void stop() override {}
    bool calibrated() const override { return true; }
    int code(unsigned) const override { return -1; }
};

LensProfile load_profile(const std::string &file)
{
    if (!file.empty()) {
        return LensProfile::load(file);
    }
    const char *folder = std::getenv("DFF_LENS_PROFILES");
    return LensProfile::load(std::string(folder ? folder : LENS_PROFILES_DIR) +
                             "/varioptic-C-C-39N0-250.yaml");
}

} // namespace

std::unique_ptr<Lens> open_lens(const LensUri &uri, const LensSurroundings &surroundings)
{
    const bool has_profile = uri.kind == LensKind::Fpga || uri.kind == LensKind::Max14574;
    if (!surroundings.profile.empty() && !has_profile)
        throw std::invalid_argument("lens-profile goes with lens=fpga: and lens=max14574: only");
    switch (uri.kind) {
    case LensKind::Fpga:
        return std::make_unique<FpgaSweepLens>(std::make_unique<LinuxI2cBus>(uri.device, uri.address),
                                               load_profile(surroundings.profile));
    case LensKind::Max14574:
        return std::make_unique<Max14574Lens>(std::make_unique<LinuxI2cBus>(uri.device, uri.address),
                                              load_profile(surroundings.profile));
    case LensKind::GenICam:
        if (!surroundings.features) {
            throw LensError("the lens genicam:" + uri.feature +
                            " is in a camera that lenssweepsrc has opened");
        }
        return std::make_unique<GenicamLens>(*surroundings.features, uri.feature);
    case LensKind::V4l2:
        return std::make_unique<V4l2Lens>(uri.device);
    case LensKind::None:
        break;
    }
    return std::make_unique<UnmovedLens>();
}

} // namespace dff
