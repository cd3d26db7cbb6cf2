# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
#
# What only Vivado takes, beside arty_z7.xdc. Inputs are asynchronous and synchronised; outputs have no clock to keep
# time with.
set_false_path -from [get_ports {reset_button run host_scl host_sda lens_scl lens_sda}]
set_false_path -to [get_ports {trigger sync busy error host_sda lens_scl lens_sda}]
