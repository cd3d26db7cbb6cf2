/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "optics/lens_profile.h"

#include "optics/settings_file.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>
#include <stdexcept>

namespace dff {

namespace {

constexpr Range dioptres{-1000.0, 1000.0};
constexpr Range volts_rms{0.0, 1000.0};
constexpr Range max14515_codes{0.0, 255.0};
constexpr Range microseconds{0.0, 1e6};

std::vector<double> rising_numbers(const FileEntries &entries, const char *name, Range range)
{
    std::vector<double> numbers = entries.numbers(name, 2, 1000, range);
    if (std::adjacent_find(numbers.begin(), numbers.end(), std::greater_equal<>()) != numbers.end())
        entries.fail(std::string(name) + " must be numbers, each greater than the one before");
    return numbers;
}

LensDriverKind driver_in(const FileEntries &entries)
{
    const std::string name = entries.has("driver") ? entries.text("driver") : "MAX14574";
    if (name != "MAX14574" && name != "MAX14515")
        entries.fail("driver is \"" + name + "\" and must be MAX14574 or MAX14515");
    return name == "MAX14515" ? LensDriverKind::Max14515 : LensDriverKind::Max14574;
}

std::chrono::microseconds whole_microseconds(double value)
{
    return std::chrono::microseconds{std::lround(value)};
}

} // namespace

LensProfile LensProfile::load(const std::string &file)
try {
    const FileEntries entries("the lens profile", file);
    LensProfile profile;
    profile.lens_ = entries.text("lens");
    profile.nominal_ = entries.number("nominal", {0.0, 1.0}) != 0.0;
    profile.power_at_infinity_ = entries.number("power_at_infinity", dioptres);
    profile.lens_powers_ = rising_numbers(entries, "lens_power", dioptres);
    profile.driver_ = driver_in(entries);
    const bool has_codes = profile.driver_ == LensDriverKind::Max14515;
    const char *drives = has_codes ? "codes" : "volts", *others = has_codes ? "volts" : "codes";
    if (entries.has(others))
        entries.fail(std::string(others) + " are for a " + (has_codes ? "MAX14574" : "MAX14515") +
                     ": leave them out, or name it as the driver");
    profile.drives_ = rising_numbers(entries, drives, has_codes ? max14515_codes : volts_rms);
    if (profile.drives_.size() != profile.lens_powers_.size())
        entries.fail("lens_power and " + std::string(drives) + " differ in length");
    profile.settle_ = whole_microseconds(entries.number("settle_us", microseconds));
    profile.overdrive_ = entries.number_or("overdrive", 0.0, {-10.0, 10.0});
    profile.overdrive_delay_ = whole_microseconds(entries.number_or("overdrive_delay_us", 0.0, microseconds));
    return profile;
} catch (const std::runtime_error &error) {
    throw std::invalid_argument(error.what()); /* as of other settings that cannot be used */
}

double LensProfile::drive(double vergence) const
{
    constexpr double rounding = 1e-9; /* dioptres */
    const double power = vergence + power_at_infinity_;
    if (!(power >= lens_powers_.front() - rounding && power <= lens_powers_.back() + rounding)) {
        std::ostringstream text;
        text << "the lens " << lens_ << " reaches " << farthest() << " to " << nearest() << " dioptres, not "
             << vergence;
        throw std::invalid_argument(text.str());
    }
    const auto above = std::upper_bound(lens_powers_.begin() + 1, lens_powers_.end() - 1, power);
    const auto k = static_cast<std::size_t>(above - lens_powers_.begin()) - 1;
    const double part = (power - lens_powers_[k]) / (lens_powers_[k + 1] - lens_powers_[k]);
    return std::lerp(drives_[k], drives_[k + 1], std::clamp(part, 0.0, 1.0));
}

} // namespace dff
