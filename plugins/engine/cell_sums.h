/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace dff {

/* Sums of samples of 8 bits over cells of side x side, a row of cells at a time. Two neighbouring samples are
 * read as one number, whose halves are added up: compilers make vectors of that. */
template <unsigned side> class CellSums {
    static_assert(side == 2 || side == 4);

public:
    explicit CellSums(size_t cells) : pairs_(cells * side / 2), sums_(cells) {}

    /* Of the cells whose rows are `stride` bytes apart and begin at `first`. Good until the next call. */
    std::span<const int32_t> of(const std::byte *first, size_t stride)
    {
        uint16_t *pairs = pairs_.data();
        for (size_t i = 0; i < pairs_.size(); i++) {
            uint16_t sum = 0;
            for (unsigned y = 0; y < side; y++)
                sum = static_cast<uint16_t>(sum + halves<uint16_t, 8>(first + y * stride + 2 * i));
            pairs[i] = sum;
        }
        int32_t *sums = sums_.data();
        for (size_t i = 0; i < sums_.size(); i++)
            sums[i] = side == 2 ? pairs[i]
                                : static_cast<int32_t>(halves<uint32_t, 16>(
                                      reinterpret_cast<const std::byte *>(pairs + 2 * i)));
        return sums_;
    }

private:
    template <typename Two, unsigned bits> static Two halves(const std::byte *at)
    {
        Two two;
        std::memcpy(&two, at, sizeof two);
        constexpr Two lower = (Two{1} << bits) - 1;
        return static_cast<Two>(static_cast<Two>(two & lower) + static_cast<Two>(two >> bits));
    }

    std::vector<uint16_t> pairs_;
    std::vector<int32_t> sums_;
};

} // namespace dff
