/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>

namespace dff::max14574 {

/* Registers of the liquid lens driver MAX14574 and their bits. A code of 10 bits is staged in two of them,
 * and reaches the lens with the command `update_output`. */
enum class Register : std::uint8_t {
    Status = 0x00,
    UserMode = 0x03,
    OisLsb = 0x04, /* bits 7..6: bits 1..0 of the code */
    Llv4 = 0x08,   /* bits 9..2 of the code */
    Command = 0x09
};

constexpr std::uint8_t status_too_hot = 1 << 4;
constexpr std::uint8_t status_no_high_voltage = 1 << 2;
constexpr std::uint8_t user_mode_active = 0x03;
constexpr std::uint8_t user_mode_sleep = 0x00;
constexpr std::uint8_t command_update_output = 0x02;

} // namespace dff::max14574
