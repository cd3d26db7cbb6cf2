/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "max14574_lens.h"

#include "i2c_retry.h"
#include "interruptible_sleep.h"
#include "lens_driver.h"

#include <algorithm>
#include <stdexcept>

namespace dff {

using max14574::Register;

namespace {

/* The high voltage comes up after waking: a guess at many times what is needed, once a start. */
constexpr std::chrono::milliseconds wake_time{50};

} // namespace

Max14574Lens::Max14574Lens(std::unique_ptr<I2cBus> bus, LensProfile profile)
    : bus_(std::move(bus)), profile_(std::move(profile))
{
    if (profile_.driver() != LensDriverKind::Max14574) {
        throw std::invalid_argument("the profile of the lens " + profile_.lens() +
                                    " is for another driver than the MAX14574");
    }
    with_retries([this] { bus_->read_byte(static_cast<std::uint8_t>(Register::Status)); }, [] {});
}

Max14574Lens::~Max14574Lens()
{
    sleep_quietly();
}

void Max14574Lens::sleep_quietly() noexcept
{
    try_quietly([this] {
        bus_->write_byte(static_cast<std::uint8_t>(Register::UserMode), max14574::user_mode_sleep);
    });
}

void Max14574Lens::write(Register number, std::uint8_t value)
{
    with_retries([&] { bus_->write_byte(static_cast<std::uint8_t>(number), value); },
                 [this] { sleep_quietly(); });
}

void Max14574Lens::prepare(const LensSweep &sweep)
{
    std::vector<std::uint16_t> codes;
    for (unsigned plane = 0; plane < sweep.plan.planes(); ++plane) {
        codes.push_back(max14574_driver.code(profile_.drive(sweep.plan.power(plane))));
    }
    codes_ = std::move(codes);
}

void Max14574Lens::start()
{
    write(Register::UserMode, max14574::user_mode_active);
    settled_at_ = std::chrono::steady_clock::now() + wake_time;
}

void Max14574Lens::stop()
{
    write(Register::UserMode, max14574::user_mode_sleep);
}

void Max14574Lens::move_to(unsigned plane)
{
    const unsigned code = codes_.at(plane);
    write(Register::OisLsb, static_cast<std::uint8_t>((code & 3U) << 6));
    write(Register::Llv4, static_cast<std::uint8_t>(code >> 2));
    write(Register::Command, max14574::command_update_output);
    settled_at_ = std::max(settled_at_, std::chrono::steady_clock::now()) + profile_.settle();
}

bool Max14574Lens::wait_settled(const std::stop_token &stop)
{
    if (!sleep_until(settled_at_, stop)) {
        return false;
    }
    const auto status =
        with_retries([this] { return bus_->read_byte(static_cast<std::uint8_t>(Register::Status)); },
                     [this] { sleep_quietly(); });
    if (status & (max14574::status_too_hot | max14574::status_no_high_voltage)) {
        sleep_quietly();
        throw LensError(status & max14574::status_too_hot
                            ? "the MAX14574 has shut down since it is too hot"
                            : "the MAX14574 does not reach its voltage: check its supply and the lens");
    }
    return true;
}

} // namespace dff
