# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""dff-rerun: a swept lens in a rerun viewer. The capture is dff-studio's."""
