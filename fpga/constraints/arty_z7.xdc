# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
#
# lens_sweep_top on the Digilent Arty Z7-10 or Z7-20. Pins after Digilent's master constraints of the board, rev. B.
# What to connect where: doc/wiring.md.

# 125 MHz from the Ethernet PHY
set_property -dict {PACKAGE_PIN H16 IOSTANDARD LVCMOS33} [get_ports clk]
create_clock -name sys_clk -period 8.000 [get_ports clk]

# BTN0
set_property -dict {PACKAGE_PIN D19 IOSTANDARD LVCMOS33} [get_ports reset_button]

# Pmod JA: camera and host lines. The pull-downs keep the lines at rest while nothing is connected
set_property -dict {PACKAGE_PIN Y18 IOSTANDARD LVCMOS33 SLEW SLOW DRIVE 8} [get_ports trigger] ;# JA1
set_property -dict {PACKAGE_PIN Y19 IOSTANDARD LVCMOS33 SLEW SLOW DRIVE 8} [get_ports sync]    ;# JA2
set_property -dict {PACKAGE_PIN Y16 IOSTANDARD LVCMOS33 PULLDOWN true}     [get_ports run]     ;# JA3

# Pmod JB: lens bus and host bus. The internal pull-ups only define idle lines; fit 2.2 kOhm to 3.3 V
set_property -dict {PACKAGE_PIN W14 IOSTANDARD LVCMOS33 SLEW SLOW DRIVE 8 PULLUP true} [get_ports lens_scl] ;# JB1
set_property -dict {PACKAGE_PIN Y14 IOSTANDARD LVCMOS33 SLEW SLOW DRIVE 8 PULLUP true} [get_ports lens_sda] ;# JB2
set_property -dict {PACKAGE_PIN V16 IOSTANDARD LVCMOS33 PULLUP true}                   [get_ports host_scl] ;# JB7
set_property -dict {PACKAGE_PIN W16 IOSTANDARD LVCMOS33 SLEW SLOW DRIVE 8 PULLUP true} [get_ports host_sda] ;# JB8

# LD0 and LD1
set_property -dict {PACKAGE_PIN R14 IOSTANDARD LVCMOS33} [get_ports busy]
set_property -dict {PACKAGE_PIN P14 IOSTANDARD LVCMOS33} [get_ports error]

# Inputs are asynchronous and synchronised; outputs have no clock to keep time with
set_property ASYNC_REG true [get_cells -hierarchical -filter {NAME =~ *synchronize_*/metastable_reg || NAME =~ *synchronize_*/stable_reg}]
set_false_path -from [get_ports {reset_button run host_scl host_sda lens_scl lens_sda}]
set_false_path -to [get_ports {trigger sync busy error host_sda lens_scl lens_sda}]
