/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/**
 * SECTION:gstdffcapture
 * @short_description: a swept lens as one element, whatever it is made of
 *
 * What dff-rtsp-server and dff-studio take as their source: any pipeline whose outputs are found by name.
 */
#include "gstdffcapture.h"

/* The outputs, and what their frames must be. One of the first SUFFICIENT must be there. */
static const struct {
    const gchar *name, *caps;
} outputs[] = {
    {"depth", "video/x-raw, format=GRAY16_LE"},
    {"uncertainty", "video/x-raw, format=GRAY16_LE"},
    {"aif", "video/x-raw"},
    {"planes", "ANY"},
    {"confidence", "video/x-raw, format=GRAY8"},
    {"motion", "video/x-raw, format=GRAY8"},
};
#define SUFFICIENT 4

static GstPad *free_pad(GstElement *element, const gchar *name)
{
    GstPad *found = NULL;

    GST_OBJECT_LOCK(element);
    for (const GList *item = element->srcpads; item && !found; item = item->next)
        if (!gst_pad_is_linked(item->data) && (!name || g_str_equal(GST_OBJECT_NAME(item->data), name)))
            found = gst_object_ref(item->data);
    GST_OBJECT_UNLOCK(element);
    return found;
}

/* The free source pad of the element of that name, or a new one if it is a tee; else that of this name of any
 * element. */
static GstPad *find_output(GstBin *bin, const gchar *name)
{
    GstPad *found = NULL;
    GstElement *element = gst_bin_get_by_name(bin, name);

    if (element) {
        found = free_pad(element, NULL);
        if (!found)
            found = gst_element_request_pad_simple(element, "src_%u");
        gst_object_unref(element);
        return found;
    }
    GST_OBJECT_LOCK(bin);
    for (const GList *item = bin->children; item && !found; item = item->next)
        found = free_pad(item->data, name);
    GST_OBJECT_UNLOCK(bin);
    return found;
}

/* Gives out of `bin` what a pad gives that may lie in bins of its own. */
static void give_out(GstElement *bin, GstPad *pad, const gchar *name)
{
    GstObject *around = gst_object_get_parent(GST_OBJECT(pad));

    for (;;) {
        GstObject *element = around;

        around = gst_object_get_parent(element);
        gst_object_unref(element);
        pad = gst_ghost_pad_new(around == GST_OBJECT(bin) ? name : NULL, pad);
        gst_element_add_pad(GST_ELEMENT(around), pad);
        if (around == GST_OBJECT(bin))
            break;
    }
    gst_object_unref(around);
}

/**
 * gst_dff_capture_new:
 * @launch: a pipeline in the notation of gst-launch-1.0
 * @error: why there is none, in words for the user
 *
 * Makes a bin of a description. Its source pads are the outputs of the capture: "depth", "uncertainty", "aif"
 * (the all-in-focus picture), "planes", "confidence" and "motion", as far as they are there, and one of the
 * first four at least. Each is the free source pad of the element of that name, or a new one if that element
 * is a tee, or else the free source pad of that name of any element.
 *
 * Returns: (transfer floating): the bin
 *
 * Since: 0.1
 */
GstElement *gst_dff_capture_new(const gchar *launch, GError **error)
{
    GstElement *capture = NULL;
    gboolean suffices = FALSE;

    g_return_val_if_fail(launch != NULL, NULL);

    capture = gst_parse_bin_from_description_full(launch, FALSE, NULL, GST_PARSE_FLAG_FATAL_ERRORS, error);
    if (!capture) {
        g_prefix_error(error, "The source pipeline cannot be used: ");
        return NULL;
    }
    for (guint i = 0; i < G_N_ELEMENTS(outputs); i++) {
        GstPad *pad = find_output(GST_BIN(capture), outputs[i].name);

        if (!pad)
            continue;
        give_out(capture, pad, outputs[i].name);
        gst_object_unref(pad);
        suffices = suffices || i < SUFFICIENT;
    }
    if (suffices)
        return capture;
    g_set_error(
        error, GST_CORE_ERROR, GST_CORE_ERROR_PAD,
        "The source pipeline has no output: name the element whose source pad gives the depth depth, "
        "that of its uncertainty uncertainty, that of the all-in-focus picture aif, that of the planes "
        "planes; if the pad is linked, a tee behind it");
    gst_object_ref_sink(capture);
    gst_object_unref(capture);
    return NULL;
}

/**
 * gst_dff_capture_check_caps:
 * @output: the name of an output
 * @caps: what its frames are
 * @error: what they must be instead, in words for the user
 *
 * Whether frames are what an output of this name must give.
 *
 * Returns: %TRUE if they are
 *
 * Since: 0.1
 */
gboolean gst_dff_capture_check_caps(const gchar *output, const GstCaps *caps, GError **error)
{
    g_return_val_if_fail(output != NULL && caps != NULL, FALSE);

    for (guint i = 0; i < G_N_ELEMENTS(outputs); i++) {
        GstCaps *wanted = NULL;
        gboolean fits = FALSE;

        if (!g_str_equal(outputs[i].name, output))
            continue;
        wanted = gst_caps_from_string(outputs[i].caps);
        fits = gst_caps_is_subset(caps, wanted);
        gst_caps_unref(wanted);
        if (!fits) {
            gchar *text = gst_caps_to_string(caps);

            g_set_error(error, GST_STREAM_ERROR, GST_STREAM_ERROR_FORMAT,
                        "The output %s of the source pipeline must be %s, but is %s", output, outputs[i].caps,
                        text);
            g_free(text);
        }
        return fits;
    }
    g_return_val_if_reached(FALSE);
}
