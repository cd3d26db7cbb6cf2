-- SPDX-License-Identifier: LGPL-2.1-or-later
-- Copyright (C) 2026 the gst-plugins-dff authors
-- Made by fpga/generate.py from fpga/registers.toml; do not edit.

library ieee;
  use ieee.std_logic_1164.all;

package sweep_registers_pkg is

  subtype word_t is std_ulogic_vector(15 downto 0);

  type words_t is array (natural range <>) of word_t;

  constant WORD_COUNT : positive := 30;

  -- Word numbers

  constant WORD_IDENTITY         : natural := 0;
  constant WORD_VERSION          : natural := 1;
  constant WORD_CONTROL          : natural := 2;
  constant WORD_STATUS           : natural := 3;
  constant WORD_ERROR            : natural := 4;
  constant WORD_ERROR_PLANE      : natural := 5;
  constant WORD_SWEEP_COUNT_LOW  : natural := 6;
  constant WORD_SWEEP_COUNT_HIGH : natural := 7;
  constant WORD_FRAME_COUNT_LOW  : natural := 8;
  constant WORD_FRAME_COUNT_HIGH : natural := 9;
  constant WORD_LENS_GAP_US      : natural := 10;
  constant WORD_LENS_STAGE_US    : natural := 11;
  constant WORD_COMMIT           : natural := 12;
  constant WORD_PLANES           : natural := 13;
  constant WORD_SHAPE            : natural := 14;
  constant WORD_PERIOD_US        : natural := 15;
  constant WORD_EXPOSURE_US      : natural := 16;
  constant WORD_FLYBACK_US       : natural := 17;
  constant WORD_TRIGGER_WIDTH_US : natural := 18;
  constant WORD_OPTO_ON_US       : natural := 19;
  constant WORD_OPTO_OFF_US      : natural := 20;
  constant WORD_LENS_ADDRESS     : natural := 21;
  constant WORD_LENS_START       : natural := 22;
  constant WORD_LENS_STAGE       : natural := 23;
  constant WORD_LENS_COMMIT      : natural := 24;
  constant WORD_PLANE_SELECT     : natural := 25;
  constant WORD_PLANE_CODE_A     : natural := 26;
  constant WORD_PLANE_DELAY_US   : natural := 27;
  constant WORD_PLANE_CODE_B     : natural := 28;
  constant WORD_PLANE_SETTLE_US  : natural := 29;

  -- Fields of one bit: its number

  constant CONTROL_ENABLE           : natural := 0;
  constant CONTROL_GATED            : natural := 1;
  constant STATUS_BUSY              : natural := 0;
  constant STATUS_TABLE_VALID       : natural := 1;
  constant STATUS_COMMIT_PENDING    : natural := 2;
  constant STATUS_DOWNWARD          : natural := 3;
  constant STATUS_RUN               : natural := 4;
  constant STATUS_FAILED            : natural := 5;
  constant ERROR_LENS_NACK          : natural := 0;
  constant ERROR_LENS_STRETCH       : natural := 1;
  constant ERROR_LENS_STUCK         : natural := 2;
  constant ERROR_LENS_ARBITRATION   : natural := 3;
  constant ERROR_LATE               : natural := 4;
  constant ERROR_TABLE_PLANES       : natural := 5;
  constant ERROR_TABLE_TIMING       : natural := 6;
  constant ERROR_TABLE_CODE         : natural := 7;
  constant COMMIT_COMMIT            : natural := 0;
  constant SHAPE_TRIANGLE           : natural := 0;
  constant SHAPE_TRIGGER_ACTIVE_LOW : natural := 1;
  constant LENS_ADDRESS_DIRECT      : natural := 7;

  -- Longer fields: their range

  subtype identity_value_t is natural range 15 downto 0;

  subtype version_minor_t is natural range 7 downto 0;

  subtype version_major_t is natural range 15 downto 8;

  subtype status_plane_t is natural range 11 downto 6;

  subtype error_plane_plane_t is natural range 5 downto 0;

  subtype sweep_count_low_value_t is natural range 15 downto 0;

  subtype sweep_count_high_value_t is natural range 15 downto 0;

  subtype frame_count_low_value_t is natural range 15 downto 0;

  subtype frame_count_high_value_t is natural range 15 downto 0;

  subtype lens_gap_us_value_t is natural range 15 downto 0;

  subtype lens_stage_us_value_t is natural range 15 downto 0;

  subtype planes_value_t is natural range 15 downto 0;

  subtype period_us_value_t is natural range 15 downto 0;

  subtype exposure_us_value_t is natural range 15 downto 0;

  subtype flyback_us_value_t is natural range 15 downto 0;

  subtype trigger_width_us_value_t is natural range 15 downto 0;

  subtype opto_on_us_value_t is natural range 7 downto 0;

  subtype opto_off_us_value_t is natural range 7 downto 0;

  subtype lens_address_value_t is natural range 6 downto 0;

  subtype lens_start_register_t is natural range 7 downto 0;

  subtype lens_start_value_t is natural range 15 downto 8;

  subtype lens_stage_low_register_t is natural range 7 downto 0;

  subtype lens_stage_high_register_t is natural range 15 downto 8;

  subtype lens_commit_register_t is natural range 7 downto 0;

  subtype lens_commit_value_t is natural range 15 downto 8;

  subtype plane_select_plane_t is natural range 5 downto 0;

  subtype plane_code_a_value_t is natural range 15 downto 0;

  subtype plane_delay_us_value_t is natural range 15 downto 0;

  subtype plane_code_b_value_t is natural range 15 downto 0;

  subtype plane_settle_us_value_t is natural range 15 downto 0;

  -- The words after reset

  constant DEFAULTS : words_t(0 to WORD_COUNT - 1) :=
  (
    WORD_IDENTITY         => x"DFF5",
    WORD_VERSION          => x"0101",
    WORD_CONTROL          => x"0000",
    WORD_STATUS           => x"0000",
    WORD_ERROR            => x"0000",
    WORD_ERROR_PLANE      => x"0000",
    WORD_SWEEP_COUNT_LOW  => x"0000",
    WORD_SWEEP_COUNT_HIGH => x"0000",
    WORD_FRAME_COUNT_LOW  => x"0000",
    WORD_FRAME_COUNT_HIGH => x"0000",
    WORD_LENS_GAP_US      => x"0000",
    WORD_LENS_STAGE_US    => x"0000",
    WORD_COMMIT           => x"0000",
    WORD_PLANES           => x"0006",
    WORD_SHAPE            => x"0000",
    WORD_PERIOD_US        => x"1900",
    WORD_EXPOSURE_US      => x"1770",
    WORD_FLYBACK_US       => x"0000",
    WORD_TRIGGER_WIDTH_US => x"0064",
    WORD_OPTO_ON_US       => x"0000",
    WORD_OPTO_OFF_US      => x"0000",
    WORD_LENS_ADDRESS     => x"0077",
    WORD_LENS_START       => x"0303",
    WORD_LENS_STAGE       => x"0804",
    WORD_LENS_COMMIT      => x"0209",
    WORD_PLANE_SELECT     => x"0000",
    WORD_PLANE_CODE_A     => x"0000",
    WORD_PLANE_DELAY_US   => x"0000",
    WORD_PLANE_CODE_B     => x"0000",
    WORD_PLANE_SETTLE_US  => x"0000"
  );

  -- The bits that a host can write

  constant WRITE_MASKS : words_t(0 to WORD_COUNT - 1) :=
  (
    WORD_IDENTITY         => x"0000",
    WORD_VERSION          => x"0000",
    WORD_CONTROL          => x"0003",
    WORD_STATUS           => x"0000",
    WORD_ERROR            => x"00FF",
    WORD_ERROR_PLANE      => x"0000",
    WORD_SWEEP_COUNT_LOW  => x"0000",
    WORD_SWEEP_COUNT_HIGH => x"0000",
    WORD_FRAME_COUNT_LOW  => x"0000",
    WORD_FRAME_COUNT_HIGH => x"0000",
    WORD_LENS_GAP_US      => x"0000",
    WORD_LENS_STAGE_US    => x"0000",
    WORD_COMMIT           => x"0001",
    WORD_PLANES           => x"FFFF",
    WORD_SHAPE            => x"0003",
    WORD_PERIOD_US        => x"FFFF",
    WORD_EXPOSURE_US      => x"FFFF",
    WORD_FLYBACK_US       => x"FFFF",
    WORD_TRIGGER_WIDTH_US => x"FFFF",
    WORD_OPTO_ON_US       => x"00FF",
    WORD_OPTO_OFF_US      => x"00FF",
    WORD_LENS_ADDRESS     => x"00FF",
    WORD_LENS_START       => x"FFFF",
    WORD_LENS_STAGE       => x"FFFF",
    WORD_LENS_COMMIT      => x"FFFF",
    WORD_PLANE_SELECT     => x"003F",
    WORD_PLANE_CODE_A     => x"FFFF",
    WORD_PLANE_DELAY_US   => x"FFFF",
    WORD_PLANE_CODE_B     => x"FFFF",
    WORD_PLANE_SETTLE_US  => x"FFFF"
  );

end package sweep_registers_pkg;
