/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "optics/lens_profile.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

namespace {

const std::string good = "lens: \"test\"\nnominal: 0\npower_at_infinity: 1.0\nlens_power: [ 0, 2.0, 6.0 ]\n"
                         "volts: [ 30, 40.0, 50.0 ]\nsettle_us: 1500\n";

/* A profile file with these lines, gone afterwards. */
class ProfileFile {
public:
    explicit ProfileFile(const std::string &lines)
        : path_(std::filesystem::temp_directory_path() /
                ("dff-profile-" + std::to_string(getpid()) + ".yaml"))
    {
        std::ofstream(path_) << "%YAML:1.0\n---\n" << lines;
    }
    ~ProfileFile() { std::filesystem::remove(path_); }
    std::string path() const { return path_.string(); }

private:
    std::filesystem::path path_;
};

std::string fault_of(const std::string &lines)
{
    const ProfileFile file(lines);
    try {
        dff::LensProfile::load(file.path());
    } catch (const std::invalid_argument &error) {
        EXPECT_NE(std::string(error.what()).find(file.path()), std::string::npos) << error.what();
        return error.what();
    }
    return "";
}

std::string with(std::string from, const std::string &line, const std::string &other)
{
    return from.replace(from.find(line), line.size(), other);
}

} // namespace

TEST(LensProfile, volts_lie_on_straight_lines_between_the_given_ones)
{
    const auto profile = dff::LensProfile::load(ProfileFile(good).path());
    EXPECT_EQ(profile.lens(), "test");
    EXPECT_FALSE(profile.nominal());
    EXPECT_DOUBLE_EQ(profile.farthest(), -1.0);
    EXPECT_DOUBLE_EQ(profile.nearest(), 5.0);
    EXPECT_DOUBLE_EQ(profile.drive(-1.0), 30.0);
    EXPECT_DOUBLE_EQ(profile.drive(0.0), 35.0);
    EXPECT_DOUBLE_EQ(profile.drive(1.0), 40.0);
    EXPECT_DOUBLE_EQ(profile.drive(4.0), 47.5);
    EXPECT_DOUBLE_EQ(profile.drive(5.0), 50.0);
    EXPECT_EQ(profile.settle().count(), 1500);
    EXPECT_EQ(profile.overdrive(), 0.0);
    EXPECT_EQ(profile.overdrive_delay().count(), 0);
}

TEST(LensProfile, nearer_always_takes_more_volts)
{
    const auto profile = dff::LensProfile::load(ProfileFile(good).path());
    for (double vergence = -1.0; vergence < 4.99; vergence += 0.01) {
        EXPECT_LT(profile.drive(vergence), profile.drive(vergence + 0.01));
    }
}

TEST(LensProfile, vergence_that_the_lens_does_not_reach_is_an_error_with_the_range)
{
    const auto profile = dff::LensProfile::load(ProfileFile(good).path());
    for (const double vergence : {-1.1, 5.1, 1e9}) {
        try {
            profile.drive(vergence);
            ADD_FAILURE() << vergence;
        } catch (const std::invalid_argument &error) {
            EXPECT_NE(std::string(error.what()).find("reaches -1 to 5 dioptres"), std::string::npos)
                << error.what();
        }
    }
}

TEST(LensProfile, faults_of_a_file_are_told_with_its_name)
{
    EXPECT_EQ(fault_of(good), "");
    EXPECT_NE(
        fault_of(with(good, "volts: [ 30, 40.0, 50.0 ]", "volts: [ 30, 50.0, 40.0 ]")).find("volts must"),
        std::string::npos);
    EXPECT_NE(
        fault_of(with(good, "volts: [ 30, 40.0, 50.0 ]", "volts: [ 30, 50.0 ]")).find("differ in length"),
        std::string::npos);
    EXPECT_NE(fault_of(with(good, "lens_power: [ 0, 2.0, 6.0 ]", "lens_power: [ 0, 0, x ]"))
                  .find("lens_power[2] is not a number"),
              std::string::npos);
    EXPECT_NE(fault_of(with(good, "settle_us: 1500", "settle_us: -1")).find("settle_us"), std::string::npos);
    EXPECT_NE(fault_of(with(good, "nominal: 0\n", "")).find("nominal"), std::string::npos);
    EXPECT_NE(fault_of(with(good, "power_at_infinity: 1.0", "power_at_infinity: 1e300"))
                  .find("power_at_infinity is 1e+300 and must be -1000 to 1000"),
              std::string::npos);
    EXPECT_NE(fault_of(with(good, "50.0", ".inf")).find("volts[2] is inf and must be 0 to 1000"),
              std::string::npos);
    EXPECT_NE(fault_of(good + "overdrive: .nan\n").find("overdrive is nan"), std::string::npos);
    EXPECT_NE(fault_of("lens: [ \"never closed\n").find("profile"), std::string::npos);
    EXPECT_THROW(dff::LensProfile::load("/does/not/exist.yaml"), std::invalid_argument);
    EXPECT_THROW(dff::LensProfile::load("/"), std::invalid_argument);
}

TEST(LensProfile, a_max14515_is_told_codes)
{
    EXPECT_EQ(dff::LensProfile::load(ProfileFile(good).path()).driver(), dff::LensDriverKind::Max14574);
    EXPECT_EQ(dff::LensProfile::load(ProfileFile(good + "driver: \"MAX14574\"\n").path()).driver(),
              dff::LensDriverKind::Max14574);
    const auto codes =
        with(good + "driver: \"MAX14515\"\n", "volts: [ 30, 40.0, 50.0 ]", "codes: [ 0, 100, 255 ]");
    const auto profile = dff::LensProfile::load(ProfileFile(codes).path());
    EXPECT_EQ(profile.driver(), dff::LensDriverKind::Max14515);
    EXPECT_DOUBLE_EQ(profile.drive(0.0), 50.0);
    EXPECT_DOUBLE_EQ(profile.drive(5.0), 255.0);
    EXPECT_NE(fault_of(with(codes, "255", "256")).find("codes[2] is 256 and must be 0 to 255"),
              std::string::npos);
    EXPECT_NE(fault_of(with(codes, "codes: [ 0, 100, 255 ]\n", "")).find("codes must be a list"),
              std::string::npos);
    EXPECT_NE(fault_of(good + "driver: \"MAX14515\"\n").find("volts are for a MAX14574"), std::string::npos);
    EXPECT_NE(fault_of(codes + "volts: [ 30, 40.0, 50.0 ]\n").find("volts are for a MAX14574"),
              std::string::npos);
    EXPECT_NE(fault_of(good + "codes: [ 0, 100, 255 ]\n").find("codes are for a MAX14515"),
              std::string::npos);
    EXPECT_NE(
        fault_of(good + "driver: \"HV892\"\n").find("driver is \"HV892\" and must be MAX14574 or MAX14515"),
        std::string::npos);
}

TEST(LensProfile, those_shipped_are_nominal_and_within_what_the_driver_can)
{
    unsigned shipped = 0;
    for (const auto &file : std::filesystem::directory_iterator(SHIPPED_PROFILES)) {
        SCOPED_TRACE(file.path());
        const auto profile = dff::LensProfile::load(file.path());
        EXPECT_TRUE(profile.nominal());
        EXPECT_GE(profile.drive(profile.farthest()), 24.4);
        EXPECT_LE(profile.drive(profile.nearest()), 69.9);
        EXPECT_LE(profile.farthest(), 0.0);
        EXPECT_GE(profile.nearest(), 5.0);
        shipped++;
    }
    EXPECT_EQ(shipped, 4U);
}
