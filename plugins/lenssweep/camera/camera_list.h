/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <string>
#include <vector>

namespace dff {

/* A camera that Aravis has found. */
struct ListedCamera {
    std::string id;
    std::string vendor;
    std::string model;
    std::string serial;
    std::string address; /* IP, or USB */
    std::string protocol;
};

/* Looks for cameras: asks the USB and, by a broadcast, each network. Takes about a second. */
std::vector<ListedCamera> list_cameras();

/* The id, for Aravis, of the camera with this id, serial number or address; of the first one found for an
 * empty name. An IP address need not be found: the camera may be in another network. Throws CameraError with
 * the list of those that are there. */
std::string find_camera(const std::string &name);

} // namespace dff
