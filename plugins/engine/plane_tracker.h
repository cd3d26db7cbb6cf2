/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/stack_shape.h"

namespace dff {

/* Tells which planes of a stack the stack before it had in the same place, so that what was computed of them
 * still holds: in a rolling window all but one. A plane is the same where its identity is, and its pixels at
 * a few hundred places too, since an element in between may have changed them (focalstackalign warps a plane
 * anew in each stack). Identities are believed where they go on from those of the stack before: a plane is of
 * a later sweep, and none of an earlier one. */
class PlaneTracker {
public:
    /* Bit z is set where plane z has to be computed anew. */
    uint64_t changed(const StackView &stack) const;

    /* From now on `stack` is the one before. */
    void remember(const StackView &stack);

    /* From now on there is no stack before. */
    void forget() { known_.clear(); }

private:
    struct Plane {
        std::optional<PlaneIdentity> identity;
        uint64_t fingerprint;
    };

    bool is_followed_by(const StackView &stack) const;

    std::vector<Plane> known_;
};

} // namespace dff
