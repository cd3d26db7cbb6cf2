/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>
#include <initializer_list>
#include <random>
#include <vector>

namespace dff::walk {

/* The same draws for the same seed. */
class Chance {
public:
    explicit Chance(std::uint64_t seed) : engine_(seed) {}

    /* 0 .. below - 1 */
    std::uint64_t below(std::uint64_t below) { return below ? engine_() % below : 0; }
    bool percent(unsigned percent) { return below(100) < percent; }

    template <typename T> T of(std::initializer_list<T> values)
    {
        return values.begin()[below(values.size())];
    }
    template <typename T> T &of(std::vector<T> &values) { return values[below(values.size())]; }

private:
    std::mt19937_64 engine_;
};

} // namespace dff::walk
