/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "lens_profile_file.h"

#include "lenssweep/lens/lens_driver.h"
#include "optics/lens_profile.h"
#include "whole_file.h"

#include <algorithm>
#include <functional>
#include <opencv2/core/persistence.hpp>
#include <stdexcept>

namespace dff {

namespace {

void write(const std::string &path, cv::FileStorage &storage)
{
    write_whole_file("The lens profile", path, storage.releaseAndGetString());
}

bool rises(const std::vector<double> &numbers)
{
    return std::adjacent_find(numbers.begin(), numbers.end(), std::greater_equal<>()) == numbers.end();
}

bool falls(const std::vector<double> &numbers)
{
    return std::adjacent_find(numbers.begin(), numbers.end(), std::less_equal<>()) == numbers.end();
}

void write_liquid_lens(const std::string &path, const std::string &lens, const std::vector<double> &vergences,
                       const std::vector<int> &codes, const LensProfile &like)
{
    const LensDriver &driver = driver_of(like);
    std::vector<double> drives;
    for (const int code : codes)
        drives.push_back(driver.drive(code));
    if (!rises(drives))
        throw std::runtime_error(
            "The codes of the lens do not rise as its planes become nearer: no profile of a " +
            std::string(driver.name) + " can be written");
    cv::FileStorage storage(".yml", cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
    storage.writeComment("measured by dff-calibrate: the power is 1 / metres of what is sharp");
    storage << "lens" << lens << "nominal" << 0 << "power_at_infinity" << 0.0 << "driver" << driver.name
            << "lens_power" << vergences << (like.driver() == LensDriverKind::Max14515 ? "codes" : "volts")
            << drives << "settle_us" << static_cast<double>(like.settle().count()) << "overdrive"
            << like.overdrive() << "overdrive_delay_us"
            << static_cast<double>(like.overdrive_delay().count());
    write(path, storage);
}

} // namespace

void write_focus_points(const std::string &path, const std::string &lens, std::vector<double> vergences,
                        std::vector<double> positions)
{
    cv::FileStorage storage(".yml", cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
    storage << "lens" << lens << "vergence" << vergences << "position" << positions;
    write(path, storage);
}

void write_lens_profile(const std::string &path, const std::string &lens,
                        const std::vector<double> &vergences, const std::vector<int> &codes,
                        const std::optional<std::string> &like)
{
    if (codes.empty())
        throw std::runtime_error(
            "No lens profile can be written: the planes do not say what the lens was told, or not all the "
            "same. "
            "Sweep by lens= of lenssweepsrc or lenssweeptag, whose codes are whole numbers");
    const std::vector<double> rising(vergences.rbegin(), vergences.rend());
    const std::vector<int> in_order(codes.rbegin(), codes.rend());
    if (like)
        return write_liquid_lens(path, lens, rising, in_order, LensProfile::load(*like));
    const std::vector<double> positions(in_order.begin(), in_order.end());
    if (!rises(positions) && !falls(positions))
        throw std::runtime_error(
            "No lens profile can be written: the lens was told the same, or to and fro, for "
            "planes at different distances");
    write_focus_points(path, lens, rising, positions);
}

} // namespace dff
