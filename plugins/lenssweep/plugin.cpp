/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#include "focuslensdeviceprovider.h"
#ifdef HAVE_ARAVIS
#include "lenssweepdeviceprovider.h"
#include "lenssweepsrc.h"
#endif
#include "lenssweeptag.h"
#include "lenssweeptestsrc.h"

static gboolean plugin_init(GstPlugin *plugin)
{
    const gboolean tag = GST_ELEMENT_REGISTER(lenssweeptag, plugin);
    const gboolean test_src = GST_ELEMENT_REGISTER(lenssweeptestsrc, plugin);
    const gboolean lenses = GST_DEVICE_PROVIDER_REGISTER(focuslensdeviceprovider, plugin);
#ifdef HAVE_ARAVIS
    if (!GST_ELEMENT_REGISTER(lenssweepsrc, plugin) ||
        !GST_DEVICE_PROVIDER_REGISTER(lenssweepdeviceprovider, plugin))
        return FALSE;
#endif
    return tag && test_src && lenses;
}

GST_PLUGIN_DEFINE(GST_VERSION_MAJOR, GST_VERSION_MINOR, lenssweep, "Planes taken with a swept focus",
                  plugin_init, VERSION, GST_LICENSE, PACKAGE, GST_PACKAGE_ORIGIN)
