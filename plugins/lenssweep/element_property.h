/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "lens/lens_property.h"

#include <gst/gst.h>
#include <memory>
#include <string>

/* The property `property` of the element called `name` in the pipeline that `self` is in. Throws
 * dff::LensError, saying what there is, if there is none, or it is no number that can be read and set. */
std::unique_ptr<dff::LensProperty> find_element_property(GstElement *self, const std::string &name,
                                                         const std::string &property);
