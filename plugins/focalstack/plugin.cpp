/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "config.h"

#include "common/stack_noise.h"
#include "common/stack_place.h"
#include "focalstack/focalstackalign.h"
#include "focalstack/focalstackdemux.h"
#ifdef HAVE_OPENCL
#include "focalstack/focalstackdenoise.h"
#endif
#include "focalstack/focalstackmux.h"

static gboolean plugin_init(GstPlugin *plugin)
{
    /* Plug-ins are loaded one after the other: nobody else registers these now. */
    dff::stack_noise_meta_name();
    dff::stack_place_meta_api();
    gboolean registered = FALSE;
    registered |= GST_ELEMENT_REGISTER(focalstackmux, plugin);
    registered |= GST_ELEMENT_REGISTER(focalstackdemux, plugin);
    registered |= GST_ELEMENT_REGISTER(focalstackalign, plugin);
#ifdef HAVE_OPENCL
    registered |= GST_ELEMENT_REGISTER(focalstackdenoise, plugin);
#endif
    return registered;
}

GST_PLUGIN_DEFINE(GST_VERSION_MAJOR, GST_VERSION_MINOR, focalstack,
                  "Groups, splits and aligns the planes of focal stacks", plugin_init, VERSION, GST_LICENSE,
                  PACKAGE, GST_PACKAGE_ORIGIN)
