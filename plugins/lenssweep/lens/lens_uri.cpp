/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "lens_uri.h"

#include "found_lenses.h"

#include <charconv>
#include <stdexcept>
#include <string_view>

namespace dff {

namespace {

constexpr std::uint8_t fpga_address = 0x3c;
constexpr std::uint8_t max14574_address = 0x77;
/* Those below and above are reserved by the I2C specification. */
constexpr unsigned lowest_address = 0x08;
constexpr unsigned highest_address = 0x77;

[[noreturn]] void refuse(const std::string &text, const std::string &why)
{
    throw std::invalid_argument(
        "the lens \"" + text + "\" " + why +
        ". It is one of fpga:/dev/i2c-1@0x3c, max14574:/dev/i2c-1@0x77, "
        "genicam:FocalPower, v4l2:/dev/video0, element:cam.lens-position, optotune:/dev/ttyACM0, none. " +
        describe(find_lenses(this_machine())));
}

/* Decimal, or hexadecimal after 0x. */
std::uint8_t parse_address(const std::string &text, std::string_view digits)
{
    int base = 10;
    if (digits.starts_with("0x") || digits.starts_with("0X")) {
        digits.remove_prefix(2);
        base = 16;
    }
    unsigned address = 0;
    const auto end = digits.data() + digits.size();
    const auto [stopped, error] = std::from_chars(digits.data(), end, address, base);
    if (error != std::errc{} || stopped != end || address < lowest_address || address > highest_address) {
        refuse(text, "has no I2C address from 0x08 to 0x77 after its @");
    }
    return static_cast<std::uint8_t>(address);
}

LensUri parse_i2c(const std::string &text, LensKind kind, const std::string &rest, std::uint8_t address)
{
    const auto at = rest.find('@');
    LensUri uri{kind, rest.substr(0, at), address, {}, {}};
    if (at != std::string::npos) {
        uri.address = parse_address(text, std::string_view(rest).substr(at + 1));
    }
    if (uri.device.empty()) {
        refuse(text, "names no I2C bus");
    }
    return uri;
}

/* Names of elements may have points in them, those of properties have none. */
LensUri parse_element(const std::string &text, const std::string &rest)
{
    const auto point = rest.rfind('.');
    if (point == std::string::npos || point == 0 || point + 1 == rest.size()) {
        refuse(text, "names no property of an element");
    }
    return {LensKind::Element, {}, 0, rest.substr(point + 1), rest.substr(0, point)};
}

} // namespace

LensUri LensUri::parse(const std::string &text)
{
    if (text.empty() || text == "none") {
        return {};
    }
    const auto colon = text.find(':');
    const std::string scheme = text.substr(0, colon);
    const std::string rest = colon == std::string::npos ? "" : text.substr(colon + 1);
    if (scheme == "fpga") {
        return parse_i2c(text, LensKind::Fpga, rest, fpga_address);
    }
    if (scheme == "max14574") {
        return parse_i2c(text, LensKind::Max14574, rest, max14574_address);
    }
    if (scheme == "genicam") {
        if (rest.empty()) {
            refuse(text, "names no feature of the camera");
        }
        return {LensKind::GenICam, {}, 0, rest, {}};
    }
    if (scheme == "v4l2") {
        if (rest.empty()) {
            refuse(text, "names no video device");
        }
        return {LensKind::V4l2, rest, 0, {}, {}};
    }
    if (scheme == "optotune") {
        if (rest.empty()) {
            refuse(text, "names no serial port");
        }
        return {LensKind::Optotune, rest, 0, {}, {}};
    }
    if (scheme == "element") {
        return parse_element(text, rest);
    }
    refuse(text, "is of no kind that is known");
}

} // namespace dff
