/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/opencl/shared_upload.h"

#include <gst/gst.h>

namespace dff {

/* What all elements that get this stack, each in its own thread, share of its upload. It ends with the
 * buffer, or when that goes back to its pool. Until then the memory cannot be written: whoever maps the
 * buffer for writing gets a copy of it, which has an upload of its own. Empty if the stack has no
 * GstFocalStackMeta or not one memory that can be kept from writing: its elements upload it themselves. */
std::shared_ptr<SharedUpload> shared_upload(GstBuffer *stack);

} // namespace dff
