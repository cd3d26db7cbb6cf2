/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "depth_frame.h"

#include <array>

namespace dff {

/* A colour picture of 8-bit RGB whose `width` is a multiple of 4. */
Buffer colour_frame(unsigned width, unsigned height,
                    const std::function<std::array<guint8, 3>(unsigned, unsigned)> &at);

struct EncodedFile {
    std::vector<guint8> bytes; /* empty if there was an error */
    std::string error;
};

/* What else an encoder may be given. */
struct FurtherInputs {
    Buffer stack = nullptr; /* RGB */
    unsigned planes = 0;
    Buffer uncertainty = nullptr;
};

/* What an encoder (with its properties) makes of one picture and its depth. `depth_caps` are further fields
 * of the depth's caps. */
EncodedFile encode_file(const std::string &encoder, unsigned width, unsigned height, Buffer colour,
                        Buffer depth, const std::string &depth_caps, FurtherInputs further = {});

} // namespace dff
