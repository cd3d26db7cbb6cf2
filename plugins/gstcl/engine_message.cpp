/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "gstcl/engine_message.h"

namespace dff {

namespace {

struct Cause {
    GQuark domain;
    gint code;
};

Cause cause_of(EngineError::Kind kind)
{
    switch (kind) {
    case EngineError::Kind::NoDevice:
        return {GST_RESOURCE_ERROR, GST_RESOURCE_ERROR_NOT_FOUND};
    case EngineError::Kind::TooLarge:
    case EngineError::Kind::OutOfMemory:
        return {GST_RESOURCE_ERROR, GST_RESOURCE_ERROR_NO_SPACE_LEFT};
    case EngineError::Kind::Failed:
        break;
    }
    return {GST_LIBRARY_ERROR, GST_LIBRARY_ERROR_FAILED};
}

void post(GstElement *element, GstMessageType type, const EngineError &error)
{
    const Cause cause = cause_of(error.kind());
    gst_element_message_full(element, type, cause.domain, cause.code, g_strdup(error.what()), nullptr,
                             __FILE__, GST_FUNCTION, __LINE__);
}

} // namespace

void post_engine_error(GstElement *element, const EngineError &error)
{
    post(element, GST_MESSAGE_ERROR, error);
}

void post_engine_warning(GstElement *element, const EngineError &error)
{
    post(element, GST_MESSAGE_WARNING, error);
}

} // namespace dff
