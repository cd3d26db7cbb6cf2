/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "free_pad.h"

#include <functional>

namespace dff {

namespace {

using Wanted = std::function<bool(GstPad *)>;

bool is_free(GstPad *pad)
{
    return GST_PAD_IS_SRC(pad) && !gst_pad_is_linked(pad);
}

ObjectPointer<GstPad> first_pad(GstElement *element, const Wanted &wanted)
{
    ObjectPointer<GstPad> found;
    GST_OBJECT_LOCK(element);
    for (const GList *item = element->srcpads; item && !found; item = item->next)
        if (wanted(GST_PAD(item->data)))
            found = share(GST_PAD(item->data));
    GST_OBJECT_UNLOCK(element);
    return found;
}

ObjectPointer<GstPad> first_pad_in_bin(GstBin *bin, const Wanted &wanted)
{
    ObjectPointer<GstPad> found;
    GST_OBJECT_LOCK(bin);
    for (const GList *item = bin->children; item && !found; item = item->next)
        found = first_pad(GST_ELEMENT(item->data), wanted);
    GST_OBJECT_UNLOCK(bin);
    return found;
}

} // namespace

ObjectPointer<GstPad> find_free_pad(GstBin *bin, const char *name)
{
    if (const ObjectPointer<GstElement> element{gst_bin_get_by_name(bin, name)}) {
        if (auto pad = first_pad(element.get(), is_free))
            return pad;
        return ObjectPointer<GstPad>(gst_element_request_pad_simple(element.get(), "src_%u"));
    }
    return first_pad_in_bin(
        bin, [name](GstPad *pad) { return is_free(pad) && g_strcmp0(GST_OBJECT_NAME(pad), name) == 0; });
}

} // namespace dff
