/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/plane_tracker.h"

#include <algorithm>
#include <cstring>

namespace dff {

namespace {

/* Looked at: so many rows of the first component, and so many words of 8 bytes of each. */
constexpr uint64_t rows_looked_at = 16, words_looked_at = 32;

std::optional<PlaneIdentity> identity_of(const StackView &stack, size_t z)
{
    return z < stack.identities.size() ? stack.identities[z] : std::nullopt;
}

uint64_t fingerprint(const StackView &stack, size_t z)
{
    const Component component = stack.shape.components().front();
    const RowLayout &rows = stack.layout[z];
    const uint64_t row_bytes = uint64_t{component.width} * component.sample_bytes;
    uint64_t sum = 0;
    for (uint64_t row = 0; row < rows_looked_at; row++)
        for (uint64_t place = 0; place < words_looked_at; place++) {
            const uint64_t y = (2 * row + 1) * component.height / (2 * rows_looked_at);
            const uint64_t x = place * (row_bytes - sizeof(uint64_t)) / (words_looked_at - 1);
            uint64_t word = 0;
            std::memcpy(&word, stack.memory.data() + rows.offset + rows.stride * y + x, sizeof word);
            sum = (sum ^ word) * 0x9e3779b97f4a7c15; /* Fibonacci hashing: 2^64 by the golden ratio */
            sum ^= sum >> 29;
        }
    return sum;
}

} // namespace

/* Otherwise the sweeps are not numbered, or numbered anew, and identities tell nothing. */
bool PlaneTracker::is_followed_by(const StackView &stack) const
{
    bool has_new_plane = false;
    for (size_t z = 0; z < known_.size(); z++) {
        const std::optional<PlaneIdentity> identity = identity_of(stack, z), &known = known_[z].identity;
        if (identity && known && identity->sweep < known->sweep)
            return false;
        has_new_plane = has_new_plane || (identity && identity != known);
    }
    return has_new_plane;
}

uint64_t PlaneTracker::changed(const StackView &stack) const
{
    if (!is_followed_by(stack))
        return ~uint64_t{0} >> (64 - stack.shape.planes);
    uint64_t changed = 0;
    for (size_t z = 0; z < stack.shape.planes; z++) {
        const std::optional<PlaneIdentity> identity = identity_of(stack, z);
        const bool same = identity && z < known_.size() && known_[z].identity == identity &&
                          known_[z].fingerprint == fingerprint(stack, z);
        if (!same)
            changed |= uint64_t{1} << z;
    }
    return changed;
}

void PlaneTracker::remember(const StackView &stack)
{
    known_.clear();
    for (size_t z = 0; z < stack.shape.planes; z++) {
        const std::optional<PlaneIdentity> identity = identity_of(stack, z);
        known_.push_back({identity, identity ? fingerprint(stack, z) : 0});
    }
}

} // namespace dff
