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
  use work.sweep_types_pkg.all;

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
    sweep  : out   sweep_words_t;
    pulse  : out   pulse_words_t;
    driver : out   driver_words_t;
    -- Rows in use; table_data is valid one cycle after a read
    table      : in    row_request_t;
    table_data : out   std_ulogic_vector(15 downto 0);
    -- The sweep: whether it goes, and what became of it
    run          : in    std_ulogic;
    go           : out   std_ulogic;
    idle         : in    std_ulogic;
    progress     : in    progress_t;
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

  signal host   : row_access_t;
  signal host_q : std_ulogic_vector(15 downto 0);

  signal commit            : std_ulogic;
  signal pending           : std_ulogic;
  signal apply             : std_ulogic;
  signal checked           : checked_words_t;
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
      clk               => clk,
      reset             => reset,
      word_number       => word_number,
      writable          => writable,
      read              => read,
      read_data         => read_data,
      write             => write,
      write_data        => write_data,
      table             => host,
      table_q           => host_q,
      commit            => commit,
      pending           => pending,
      apply             => apply,
      checked           => checked,
      sweep             => sweep,
      pulse             => pulse,
      driver            => driver,
      run               => run,
      go                => go,
      progress          => progress,
      sweep_faults      => sweep_faults,
      table_faults      => table_faults,
      table_fault_plane => table_fault_plane,
      error             => error
    );

  planes_table : entity work.plane_table
    generic map (
      CLOCK_HZ    => CLOCK_HZ,
      TICK_HZ     => TICK_HZ,
      LENS_BUS_HZ => LENS_BUS_HZ
    )
    port map (
      clk        => clk,
      reset      => reset,
      host       => host,
      host_q     => host_q,
      commit     => commit,
      checked    => checked,
      pending    => pending,
      apply      => apply,
      bad_planes => table_faults(0),
      bad_timing => table_faults(1),
      bad_code   => table_faults(2),
      bad_plane  => table_fault_plane,
      idle       => idle,
      boundary   => progress.boundary,
      table      => table,
      table_data => table_data
    );

end architecture rtl;
