-- SPDX-License-Identifier: LGPL-2.1-or-later
-- Copyright (C) 2026 the gst-plugins-dff authors
--
-- The host's side: its bus, the words and the table of planes. What comes out is a sweep that has been checked and is
-- in use, and whether it goes.

library ieee;
  use ieee.std_logic_1164.all;
  use ieee.numeric_std.all;

library work;
  use work.sweep_registers_pkg.all;

entity host_interface is
  generic (
    CLOCK_HZ    : positive := 125_000_000;
    TICK_HZ     : positive := 1_000_000;
    LENS_BUS_HZ : positive := 400_000;
    ADDRESS     : natural  := 16#3C#;
    HOLD_S      : real     := 300.0e-9;
    TIMEOUT_S   : real     := 25.0e-3
  );
  port (
    clk   : in    std_ulogic;
    reset : in    std_ulogic;
    -- Bus of the host
    scl_in  : in    std_ulogic;
    sda_in  : in    std_ulogic;
    sda_low : out   std_ulogic;
    -- Words in use
    planes             : out   unsigned(6 downto 0);
    triangle           : out   std_ulogic;
    trigger_active_low : out   std_ulogic;
    period             : out   unsigned(15 downto 0);
    exposure           : out   unsigned(15 downto 0);
    flyback            : out   unsigned(15 downto 0);
    trigger_width      : out   unsigned(15 downto 0);
    lead               : out   unsigned(7 downto 0);
    opto_on            : out   unsigned(7 downto 0);
    opto_off           : out   unsigned(7 downto 0);
    lens_address       : out   std_ulogic_vector(6 downto 0);
    lens_start         : out   std_ulogic_vector(15 downto 0);
    lens_stage         : out   std_ulogic_vector(15 downto 0);
    lens_commit        : out   std_ulogic_vector(15 downto 0);
    -- Rows in use; table_data is valid one cycle after table_read
    table_plane  : in    unsigned(5 downto 0);
    table_column : in    unsigned(1 downto 0);
    table_read   : in    std_ulogic;
    table_data   : out   std_ulogic_vector(15 downto 0);
    -- The sweep: whether it goes, and what became of it
    run          : in    std_ulogic;
    go           : out   std_ulogic;
    busy         : in    std_ulogic;
    idle         : in    std_ulogic;
    boundary     : in    std_ulogic;
    plane        : in    unsigned(5 downto 0);
    downward     : in    std_ulogic;
    sweep_begun  : in    std_ulogic;
    frame_begun  : in    std_ulogic;
    sweep_faults : in    std_ulogic_vector(4 downto 0);
    error        : out   std_ulogic
  );
end entity host_interface;

architecture rtl of host_interface is

  signal word_number : unsigned(6 downto 0);
  signal writable    : std_ulogic;
  signal read        : std_ulogic;
  signal read_data   : std_ulogic_vector(15 downto 0);
  signal write       : std_ulogic;
  signal write_data  : std_ulogic_vector(15 downto 0);

  signal host_plane  : unsigned(5 downto 0);
  signal host_column : unsigned(1 downto 0);
  signal host_write  : std_ulogic;
  signal host_data   : std_ulogic_vector(15 downto 0);
  signal host_q      : std_ulogic_vector(15 downto 0);
  signal host_read   : std_ulogic;

  signal commit            : std_ulogic;
  signal pending           : std_ulogic;
  signal apply             : std_ulogic;
  signal checked_planes    : unsigned(15 downto 0);
  signal checked_period    : unsigned(15 downto 0);
  signal checked_exposure  : unsigned(15 downto 0);
  signal checked_width     : unsigned(15 downto 0);
  signal checked_lead      : unsigned(7 downto 0);
  signal checked_trail     : unsigned(7 downto 0);
  signal checked_new_level : std_ulogic;
  signal table_faults      : std_ulogic_vector(2 downto 0);
  signal table_fault_plane : unsigned(5 downto 0);

begin

  slave : entity work.i2c_slave
    generic map (
      CLOCK_HZ   => CLOCK_HZ,
      ADDRESS    => ADDRESS,
      WORD_COUNT => WORD_COUNT,
      HOLD_S     => HOLD_S,
      TIMEOUT_S  => TIMEOUT_S
    )
    port map (
      clk         => clk,
      reset       => reset,
      scl_in      => scl_in,
      sda_in      => sda_in,
      sda_low     => sda_low,
      word_number => word_number,
      writable    => writable,
      read        => read,
      read_data   => read_data,
      write       => write,
      write_data  => write_data
    );

  registers : entity work.register_file
    generic map (
      CLOCK_HZ    => CLOCK_HZ,
      TICK_HZ     => TICK_HZ,
      LENS_BUS_HZ => LENS_BUS_HZ
    )
    port map (
      clk                => clk,
      reset              => reset,
      word_number        => word_number,
      writable           => writable,
      read               => read,
      read_data          => read_data,
      write              => write,
      write_data         => write_data,
      table_plane        => host_plane,
      table_column       => host_column,
      table_write        => host_write,
      table_data         => host_data,
      table_read         => host_read,
      table_q            => host_q,
      commit             => commit,
      pending            => pending,
      apply              => apply,
      checked_planes     => checked_planes,
      checked_period     => checked_period,
      checked_exposure   => checked_exposure,
      checked_width      => checked_width,
      checked_lead       => checked_lead,
      checked_trail      => checked_trail,
      checked_new_level  => checked_new_level,
      planes             => planes,
      triangle           => triangle,
      trigger_active_low => trigger_active_low,
      period             => period,
      exposure           => exposure,
      flyback            => flyback,
      trigger_width      => trigger_width,
      lead               => lead,
      opto_on            => opto_on,
      opto_off           => opto_off,
      lens_address       => lens_address,
      lens_start         => lens_start,
      lens_stage         => lens_stage,
      lens_commit        => lens_commit,
      run                => run,
      go                 => go,
      busy               => busy,
      downward           => downward,
      plane              => plane,
      sweep_begun        => sweep_begun,
      frame_begun        => frame_begun,
      sweep_faults       => sweep_faults,
      table_faults       => table_faults,
      table_fault_plane  => table_fault_plane,
      error              => error
    );

  planes_table : entity work.plane_table
    generic map (
      CLOCK_HZ    => CLOCK_HZ,
      TICK_HZ     => TICK_HZ,
      LENS_BUS_HZ => LENS_BUS_HZ
    )
    port map (
      clk           => clk,
      reset         => reset,
      host_plane    => host_plane,
      host_column   => host_column,
      host_write    => host_write,
      host_data     => host_data,
      host_read     => host_read,
      host_q        => host_q,
      commit        => commit,
      planes        => checked_planes,
      period        => checked_period,
      exposure      => checked_exposure,
      trigger_width => checked_width,
      lead          => checked_lead,
      trail         => checked_trail,
      new_level     => checked_new_level,
      pending       => pending,
      apply         => apply,
      bad_planes    => table_faults(0),
      bad_timing    => table_faults(1),
      bad_code      => table_faults(2),
      bad_plane     => table_fault_plane,
      idle          => idle,
      boundary      => boundary,
      plane         => table_plane,
      column        => table_column,
      read          => table_read,
      q             => table_data
    );

end architecture rtl;
