/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "optics/sweep_plan.h"

#include <glib-object.h>
#include <vector>

/* The properties planes, near, far and powers, which every element that labels planes has. */
struct SweepProperties {
    guint planes = 6;
    gdouble near = 5.0;
    gdouble far = 0.0;
    std::vector<gdouble> powers;

    /* Whether the planes' powers are said: near equal to far, or neither set, says nothing. */
    bool has_powers() const { return !powers.empty() || near != far; }

    /* Throws std::invalid_argument, with a message for the user, if they describe no sweep. */
    dff::SweepPlan plan() const;
};

/* Their ids; those of the element itself start at FIRST_OWN_PROPERTY. */
enum { PROP_PLANES = 1, PROP_NEAR, PROP_FAR, PROP_POWERS, FIRST_OWN_PROPERTY };

/* Who gives `near` and `far` as defaults that say nothing need not know where the planes lie. */
void install_sweep_properties(GObjectClass *klass, const SweepProperties &defaults = {});

/* Of values that are arrays of doubles. */
std::vector<gdouble> numbers_of(const GValue *array);
void put_numbers(GValue *array, const std::vector<gdouble> &numbers);

/* False if the id is not one of theirs. */
bool set_sweep_property(SweepProperties &properties, guint id, const GValue *value);
bool get_sweep_property(const SweepProperties &properties, guint id, GValue *value);
