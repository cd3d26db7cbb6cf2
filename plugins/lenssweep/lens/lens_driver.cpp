/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "lens_driver.h"

#include "max14574.h"
#include "sweep_registers.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace dff {

namespace {

using namespace sweep_registers;

constexpr unsigned table_code_bits = 10;

constexpr unsigned number(max14574::Register name)
{
    return static_cast<unsigned>(name);
}

/* Two fields that fill a word. */
constexpr std::uint16_t word(Field low, unsigned low_value, Field high, unsigned high_value)
{
    return static_cast<std::uint16_t>(low.place(low_value) | high.place(high_value));
}

} // namespace

constinit const LensDriver max14574_driver{"MAX14574",
                                           24.4,
                                           69.9,
                                           " V rms",
                                           10,
                                           {lens_address_value.place(0x77),
                                            word(lens_start_register, number(max14574::Register::UserMode),
                                                 lens_start_value, max14574::user_mode_active),
                                            word(lens_stage_low_register, number(max14574::Register::OisLsb),
                                                 lens_stage_high_register, number(max14574::Register::Llv4)),
                                            word(lens_commit_register, number(max14574::Register::Command),
                                                 lens_commit_value, max14574::command_update_output)}};

/* By programs that speak to it (fpga/doc/wiring.md): register 0 = 1 wakes it, register 1 takes the code. */
constinit const LensDriver max14515_driver{"MAX14515",
                                           0.0,
                                           255.0,
                                           "",
                                           8,
                                           {word(lens_address_value, 0x76, lens_address_direct, 1),
                                            word(lens_start_register, 0, lens_start_value, 1),
                                            lens_stage_high_register.place(1), 0}};

std::uint16_t LensDriver::code(double drive) const
{
    if (!(drive >= lowest && drive <= highest)) {
        std::ostringstream text;
        text << drive << unit << " is outside of the " << lowest << " to " << highest << unit << " of the "
             << name;
        throw std::invalid_argument(text.str());
    }
    const double highest_code = (1U << code_bits) - 1U;
    return static_cast<std::uint16_t>(std::lround((drive - lowest) / (highest - lowest) * highest_code));
}

double LensDriver::drive(int code) const
{
    const int highest_code = (1 << code_bits) - 1;
    if (code < 0 || code > highest_code)
        throw std::invalid_argument(std::to_string(code) + " is no code of the " + name +
                                    ", which has 0 to " + std::to_string(highest_code));
    return lowest + (highest - lowest) * code / highest_code;
}

std::uint16_t LensDriver::table_code(double drive) const
{
    return static_cast<std::uint16_t>(code(drive) << (table_code_bits - code_bits));
}

bool LensDriver::direct() const
{
    return lens_address_direct.get(words[0]) != 0;
}

const LensDriver &driver_of(const LensProfile &profile)
{
    return profile.driver() == LensDriverKind::Max14515 ? max14515_driver : max14574_driver;
}

} // namespace dff
