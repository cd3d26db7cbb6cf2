/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "optics/lens_profile.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/core.hpp>
#include <sstream>
#include <stdexcept>

namespace dff {

namespace {

/* The entries of one file. */
class Entries {
public:
    explicit Entries(const std::string &file) : file_(file)
    {
        try {
            storage_.open(file, cv::FileStorage::READ | cv::FileStorage::FORMAT_YAML);
        } catch (const cv::Exception &error) {
            fail(error.err);
        }
        if (!storage_.isOpened()) {
            fail("cannot be read");
        }
    }

    [[noreturn]] void fail(const std::string &fault) const
    {
        throw std::invalid_argument("the lens profile " + file_ + ": " + fault);
    }

    std::string text(const char *name) const
    {
        const cv::FileNode node = storage_[name];
        if (!node.isString()) {
            fail(std::string(name) + " is missing");
        }
        return node.string();
    }

    double number(const char *name) const
    {
        const cv::FileNode node = storage_[name];
        if (!node.isInt() && !node.isReal()) {
            fail(std::string(name) + " is missing, or no number");
        }
        return node.real();
    }

    double number(const char *name, double otherwise) const
    {
        return storage_[name].empty() ? otherwise : number(name);
    }

    std::chrono::microseconds microseconds(const char *name, double value) const
    {
        if (!(value >= 0 && value <= 1e6)) {
            fail(std::string(name) + " is not 0 to 1000000");
        }
        return std::chrono::microseconds{std::lround(value)};
    }

    std::vector<double> rising_numbers(const char *name) const
    {
        std::vector<double> numbers;
        for (const cv::FileNode &node : storage_[name]) {
            numbers.push_back(node.isInt() || node.isReal() ? node.real() : NAN);
        }
        const bool finite =
            std::all_of(numbers.begin(), numbers.end(), [](double n) { return std::isfinite(n); });
        const bool rising =
            std::adjacent_find(numbers.begin(), numbers.end(), std::greater_equal<>()) == numbers.end();
        if (numbers.size() < 2 || !finite || !rising) {
            fail(std::string(name) + " must be two or more numbers, each greater than the one before");
        }
        return numbers;
    }

private:
    std::string file_;
    cv::FileStorage storage_;
};

} // namespace

LensProfile LensProfile::load(const std::string &file)
{
    const Entries entries(file);
    LensProfile profile;
    profile.lens_ = entries.text("lens");
    profile.nominal_ = entries.number("nominal") != 0;
    profile.power_at_infinity_ = entries.number("power_at_infinity");
    profile.lens_powers_ = entries.rising_numbers("lens_power");
    profile.volts_ = entries.rising_numbers("volts");
    if (profile.volts_.size() != profile.lens_powers_.size()) {
        entries.fail("lens_power and volts differ in length");
    }
    profile.settle_ = entries.microseconds("settle_us", entries.number("settle_us"));
    profile.overdrive_ = entries.number("overdrive", 0.0);
    profile.overdrive_delay_ =
        entries.microseconds("overdrive_delay_us", entries.number("overdrive_delay_us", 0.0));
    return profile;
}

double LensProfile::volts(double vergence) const
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
    return std::lerp(volts_[k], volts_[k + 1], std::clamp(part, 0.0, 1.0));
}

} // namespace dff
