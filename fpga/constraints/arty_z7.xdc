# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
#
# lens_sweep_top on the Digilent Arty Z7-10 or Z7-20. Pins after Digilent's master constraints of the board, rev. B.
# What to connect where: doc/wiring.md. Only what nextpnr and Vivado both take; arty_z7_vivado.xdc has the rest.

# 125 MHz from the Ethernet PHY
set_property -dict {PACKAGE_PIN H16 IOSTANDARD LVCMOS33} [get_ports clk]
create_clock -period 8.000 [get_ports clk]

# BTN0
set_property -dict {PACKAGE_PIN D19 IOSTANDARD LVCMOS33} [get_ports reset_button]

# Pmod JA: camera and host lines on JA1, JA2, JA3. The pull-down keeps `run` at rest while nothing is connected
set_property -dict {PACKAGE_PIN Y18 IOSTANDARD LVCMOS33 SLEW SLOW DRIVE 8} [get_ports trigger]
set_property -dict {PACKAGE_PIN Y19 IOSTANDARD LVCMOS33 SLEW SLOW DRIVE 8} [get_ports sync]
set_property -dict {PACKAGE_PIN Y16 IOSTANDARD LVCMOS33 PULLTYPE PULLDOWN} [get_ports run]

# Pmod JB: lens bus on JB1, JB2, host bus on JB7, JB8. The internal pull-ups only define idle lines; fit 2.2 kOhm to
# 3.3 V
set_property -dict {PACKAGE_PIN W14 IOSTANDARD LVCMOS33 SLEW SLOW DRIVE 8 PULLTYPE PULLUP} [get_ports lens_scl]
set_property -dict {PACKAGE_PIN Y14 IOSTANDARD LVCMOS33 SLEW SLOW DRIVE 8 PULLTYPE PULLUP} [get_ports lens_sda]
set_property -dict {PACKAGE_PIN V16 IOSTANDARD LVCMOS33 PULLTYPE PULLUP} [get_ports host_scl]
set_property -dict {PACKAGE_PIN W16 IOSTANDARD LVCMOS33 SLEW SLOW DRIVE 8 PULLTYPE PULLUP} [get_ports host_sda]

# LD0 and LD1
set_property -dict {PACKAGE_PIN R14 IOSTANDARD LVCMOS33} [get_ports busy]
set_property -dict {PACKAGE_PIN P14 IOSTANDARD LVCMOS33} [get_ports error]
