/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace dff {

/* The GenICam features of a camera by their names, as far as a lens in the camera needs them. Every call but
 * has() throws std::runtime_error, with the feature in its text, if the camera does not do it. */
class CameraFeatures {
public:
    virtual ~CameraFeatures() = default;

    /* Whether the camera has the feature, and it is available now. */
    virtual bool has(const std::string &feature) = 0;

    /* Whether an existing feature is an IInteger (and no IFloat). */
    virtual bool is_integer(const std::string &feature) = 0;

    /* Whether the camera has the feature now, and it is an ICommand. */
    virtual bool is_command(const std::string &feature) = 0;

    /* What the camera says of an existing number's unit; mostly empty. */
    virtual std::string unit(const std::string &feature) = 0;

    virtual double get_float(const std::string &feature) = 0;
    virtual void set_float(const std::string &feature, double value) = 0;
    virtual std::pair<double, double> float_range(const std::string &feature) = 0;

    virtual std::int64_t get_integer(const std::string &feature) = 0;
    virtual void set_integer(const std::string &feature, std::int64_t value) = 0;
    virtual std::pair<std::int64_t, std::int64_t> integer_range(const std::string &feature) = 0;

    virtual std::string get_enumeration(const std::string &feature) = 0;
    virtual void set_enumeration(const std::string &feature, const std::string &value) = 0;
    virtual std::vector<std::string> enumeration_values(const std::string &feature) = 0;

    virtual void execute(const std::string &command) = 0;
};

} // namespace dff
