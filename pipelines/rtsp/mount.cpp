/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "mount.h"

#include <vector>

namespace dff {

namespace {

/* H.264 that any player takes: a whole picture every 30 frames, so that a new client sees one soon, and no
 * frame held back to code others from. config-interval=-1 would put parameters between the slices of a
 * picture, at which players take it for two. Payloaders leave 200 bytes of an Ethernet frame to the header
 * extension. */
std::string h264(const std::string &payloader)
{
    return "queue ! videoconvert ! video/x-raw,format=I420 ! x264enc tune=zerolatency speed-preset=veryfast "
           "bitrate=4000 key-int-max=30 ! video/x-h264,profile=main ! rtph264pay config-interval=1 mtu=1200 "
           "name=" +
           payloader;
}

std::string jpeg2000(const std::string &payloader)
{
    return "queue ! openjpegenc ! jpeg2000parse ! rtpj2kpay mtu=1200 name=" + payloader;
}

} // namespace

std::span<const Mount> all_mounts()
{
    static const std::vector<Mount> mounts = {
        {"/color", {"aif"}, {"x264enc"}, {}, "appsrc name=aif ! " + h264("pay0")},
        {"/depth", {"depth"}, {"openjpegenc"}, {{0, "depth"}}, "appsrc name=depth ! " + jpeg2000("pay0")},
        {"/uncertainty",
         {"uncertainty"},
         {"openjpegenc"},
         {{0, "uncertainty"}},
         "appsrc name=uncertainty ! " + jpeg2000("pay0")},
        {"/stream",
         {"aif", "depth"},
         {"x264enc", "openjpegenc"},
         {{1, "depth"}},
         "appsrc name=aif ! " + h264("pay0") + "  appsrc name=depth ! " + jpeg2000("pay1")},
        {"/hue",
         {"depth"},
         {"x264enc", "depthcolorize"},
         {{0, "depth"}},
         "appsrc name=depth ! depthcolorize palette=hue ! " + h264("pay0")},
        {"/rgbd",
         {"aif", "depth"},
         {"x264enc", "lightfieldcompose"},
         {{0, "depth"}},
         "appsrc name=aif ! queue ! videoconvert ! compose.color  appsrc name=depth ! queue ! compose.depth  "
         "lightfieldcompose name=compose layout=rgbd ! " +
             h264("pay0")},
        {"/planes",
         {"planes"},
         {},
         {},
         "appsrc name=planes ! queue ! rtpgstpay mtu=1200 config-interval=1 name=pay0"},
    };
    return mounts;
}

} // namespace dff
