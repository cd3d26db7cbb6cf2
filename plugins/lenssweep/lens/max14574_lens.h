/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "i2c_bus.h"
#include "lens.h"
#include "max14574.h"
#include "optics/lens_profile.h"

#include <chrono>
#include <memory>
#include <vector>

namespace dff {

/* A liquid lens behind a MAX14574 on an I2C bus of this machine. Its safe state is the driver asleep, without
 * voltage at the lens. */
class Max14574Lens : public SteppedLens {
public:
    /* Throws I2cError if nothing answers, std::invalid_argument for a profile of another driver. */
    Max14574Lens(std::unique_ptr<I2cBus> bus, LensProfile profile);
    ~Max14574Lens() override;

    void prepare(const LensSweep &sweep) override;
    void start() override;
    void stop() override;
    bool calibrated() const override { return true; }
    int code(unsigned plane) const override { return codes_.at(plane); }
    void move_to(unsigned plane) override;

    /* Waits for the profile's settling time; throws LensError if the driver is too hot or has no voltage. */
    bool wait_settled(const std::stop_token &stop) override;

private:
    void write(max14574::Register number, std::uint8_t value);
    void sleep_quietly() noexcept;

    std::unique_ptr<I2cBus> bus_;
    LensProfile profile_;
    std::vector<std::uint16_t> codes_;
    std::chrono::steady_clock::time_point settled_at_;
};

} // namespace dff
