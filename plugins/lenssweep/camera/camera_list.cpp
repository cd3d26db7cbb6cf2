/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "camera_list.h"

#include "camera_control.h"

#include <arv.h>
#include <mutex>

namespace dff {

namespace {

std::string text_of(const char *text)
{
    return text ? text : "";
}

std::string described(const std::vector<ListedCamera> &cameras)
{
    std::string text;
    for (const ListedCamera &camera : cameras)
        text.append(text.empty() ? "" : ", ").append(camera.id);
    return text.empty() ? "none was found: check its cable, its power, its IP address and the firewall"
                        : text;
}

bool is_address(const std::string &name)
{
    return g_hostname_is_ip_address(name.c_str()) != FALSE;
}

} // namespace

std::vector<ListedCamera> list_cameras()
{
    static std::mutex mutex; /* Aravis's list is one for all */
    const std::lock_guard lock(mutex);
    arv_update_device_list();
    std::vector<ListedCamera> cameras;
    for (unsigned i = 0; i < arv_get_n_devices(); i++)
        cameras.push_back({text_of(arv_get_device_id(i)), text_of(arv_get_device_vendor(i)),
                           text_of(arv_get_device_model(i)), text_of(arv_get_device_serial_nbr(i)),
                           text_of(arv_get_device_address(i)), text_of(arv_get_device_protocol(i))});
    return cameras;
}

std::string find_camera(const std::string &name)
{
    if (is_address(name))
        return name;
    const auto cameras = list_cameras();
    for (const ListedCamera &camera : cameras)
        if (name.empty() || name == camera.id || name == camera.serial || name == camera.address)
            return camera.id;
    if (name.empty())
        throw CameraError("no camera: " + described(cameras));
    throw CameraError("no camera is called " + name + "; there are: " + described(cameras));
}

} // namespace dff
