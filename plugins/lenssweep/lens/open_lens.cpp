/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "open_lens.h"

#include "element_lens.h"
#include "found_lenses.h"
#include "fpga_sweep_lens.h"
#include "genicam_lens.h"
#include "linux_i2c_bus.h"
#include "max14574_lens.h"
#include "optotune_lens.h"
#include "optotune_triangle.h"
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

std::optional<FocusPoints> load_points(const LensSurroundings &surroundings)
{
    if (surroundings.profile.empty())
        return std::nullopt;
    return FocusPoints::load(surroundings.profile);
}

} // namespace

static std::unique_ptr<Lens> open_kind(const LensUri &uri, const LensSurroundings &surroundings)
{
    if (!surroundings.profile.empty() && uri.kind == LensKind::None)
        throw std::invalid_argument("lens-profile goes with a lens that is moved, and lens=none is not");
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
        return std::make_unique<GenicamLens>(*surroundings.features, uri.feature, load_points(surroundings));
    case LensKind::V4l2:
        return std::make_unique<V4l2Lens>(uri.device, load_points(surroundings));
    case LensKind::Optotune:
        if (surroundings.by_itself)
            return std::make_unique<OptotuneTriangle>(uri.device, load_points(surroundings));
        return std::make_unique<OptotuneLens>(uri.device, load_points(surroundings));
    case LensKind::Element:
        if (!surroundings.find_property)
            throw LensError("the lens element:" + uri.element + "." + uri.feature +
                            " is moved by lenssweeptag, which stands in the pipeline of that element");
        return std::make_unique<ElementLens>(surroundings.find_property(uri.element, uri.feature),
                                             load_points(surroundings));
    case LensKind::None:
        break;
    }
    return std::make_unique<UnmovedLens>();
}

std::unique_ptr<Lens> open_lens(const LensUri &uri, const LensSurroundings &surroundings)
{
    try {
        return open_kind(uri, surroundings);
    } catch (const LensError &error) {
        throw LensError(std::string(error.what()) + ". " + describe(find_lenses(this_machine())));
    }
}

} // namespace dff
