-- SPDX-License-Identifier: LGPL-2.1-or-later
-- Copyright (C) 2026 the gst-plugins-dff authors
--
-- The sweep sequencer on an Arty Z7: the pins, their synchronisers, and the entities put together.

library ieee;
  use ieee.std_logic_1164.all;
  use ieee.numeric_std.all;

library work;
  use work.sweep_types_pkg.all;
  use work.timing_pkg.all;

entity lens_sweep_top is
  generic (
    CLOCK_HZ : positive := 125_000_000;
    -- Rate of the time unit of the registers; other than 1 MHz only to simulate faster
    TICK_HZ         : positive := 1_000_000;
    LENS_BUS_HZ     : positive := 400_000;
    HOST_ADDRESS    : natural  := 16#3C#;
    GLITCH_S        : real     := 50.0e-9;
    STRETCH_LIMIT_S : real     := 100.0e-6;
    HOST_HOLD_S     : real     := 300.0e-9;
    HOST_TIMEOUT_S  : real     := 25.0e-3
  );
  port (
    clk          : in    std_ulogic;
    reset_button : in    std_ulogic;
    -- Start and stop line of the host, and the sweep's answer
    run     : in    std_ulogic;
    sync    : out   std_ulogic;
    trigger : out   std_ulogic;
    busy    : out   std_ulogic;
    error   : out   std_ulogic;
    -- Open drain, with pull-ups
    host_scl : in    std_logic;
    host_sda : inout std_logic;
    lens_scl : inout std_logic;
    lens_sda : inout std_logic
  );
end entity lens_sweep_top;

architecture rtl of lens_sweep_top is

  -- Two flip-flops and the glitch filter
  constant POWER_UP_CYCLES : positive := 8;
  constant INPUT_CYCLES    : positive := 2 + to_cycles(CLOCK_HZ, GLITCH_S);

  -- Reset at power-up
  signal power_up       : natural range 0 to POWER_UP_CYCLES := POWER_UP_CYCLES;
  signal power_up_reset : std_ulogic                         := '1';
  signal button         : std_ulogic;
  signal reset          : std_ulogic                         := '1';

  signal run_level      : std_ulogic;
  signal host_scl_level : std_ulogic;
  signal host_sda_level : std_ulogic;
  signal host_sda_low   : std_ulogic;
  signal lens_scl_level : std_ulogic;
  signal lens_sda_level : std_ulogic;
  signal lens_scl_low   : std_ulogic;
  signal lens_sda_low   : std_ulogic;

  signal sweep      : sweep_words_t;
  signal pulse      : pulse_words_t;
  signal driver     : driver_words_t;
  signal table      : row_request_t;
  signal table_data : std_ulogic_vector(15 downto 0);

  signal go             : std_ulogic;
  signal idle           : std_ulogic;
  signal progress       : progress_t;
  signal trigger_active : std_ulogic;
  signal sync_active    : std_ulogic;

  signal lens_start    : std_ulogic;
  signal lens_register : std_ulogic_vector(7 downto 0);
  signal lens_value    : std_ulogic_vector(7 downto 0);
  signal lens_done     : std_ulogic;
  signal lens_fault    : std_ulogic;
  signal lens_faults   : std_ulogic_vector(3 downto 0);
  signal late          : std_ulogic;
  signal sweep_faults  : std_ulogic_vector(4 downto 0);
  signal failed        : std_ulogic;

begin

  host_sda <= '0' when host_sda_low = '1' else
              'Z';
  lens_scl <= '0' when lens_scl_low = '1' else
              'Z';
  lens_sda <= '0' when lens_sda_low = '1' else
              'Z';

  lens_fault   <= '0' when lens_faults = "0000" else
                  '1';
  sweep_faults <= late & (lens_faults and (3 downto 0 => lens_done));

  outputs : process (clk) is
  begin

    if rising_edge(clk) then
      if (power_up /= 0) then
        power_up <= power_up - 1;
      else
        power_up_reset <= '0';
      end if;
      reset <= button or power_up_reset;
      busy  <= progress.busy or trigger_active or sync_active;
      error <= failed;
      idle  <= not (progress.busy or trigger_active);
    end if;

  end process outputs;

  synchronize_button : entity work.synchronizer
    generic map (
      CLOCK_HZ    => CLOCK_HZ,
      GLITCH_S    => GLITCH_S,
      RESET_LEVEL => '0'
    )
    port map (
      clk      => clk,
      reset    => power_up_reset,
      async_in => reset_button,
      sync_out => button
    );

  synchronize_run : entity work.synchronizer
    generic map (
      CLOCK_HZ    => CLOCK_HZ,
      GLITCH_S    => GLITCH_S,
      RESET_LEVEL => '0'
    )
    port map (
      clk      => clk,
      reset    => reset,
      async_in => run,
      sync_out => run_level
    );

  synchronize_host_scl : entity work.synchronizer
    generic map (
      CLOCK_HZ => CLOCK_HZ,
      GLITCH_S => GLITCH_S
    )
    port map (
      clk      => clk,
      reset    => reset,
      async_in => to_x01(host_scl),
      sync_out => host_scl_level
    );

  synchronize_host_sda : entity work.synchronizer
    generic map (
      CLOCK_HZ => CLOCK_HZ,
      GLITCH_S => GLITCH_S
    )
    port map (
      clk      => clk,
      reset    => reset,
      async_in => to_x01(host_sda),
      sync_out => host_sda_level
    );

  synchronize_lens_scl : entity work.synchronizer
    generic map (
      CLOCK_HZ => CLOCK_HZ,
      GLITCH_S => GLITCH_S
    )
    port map (
      clk      => clk,
      reset    => reset,
      async_in => to_x01(lens_scl),
      sync_out => lens_scl_level
    );

  synchronize_lens_sda : entity work.synchronizer
    generic map (
      CLOCK_HZ => CLOCK_HZ,
      GLITCH_S => GLITCH_S
    )
    port map (
      clk      => clk,
      reset    => reset,
      async_in => to_x01(lens_sda),
      sync_out => lens_sda_level
    );

  host : entity work.host_interface
    generic map (
      CLOCK_HZ    => CLOCK_HZ,
      TICK_HZ     => TICK_HZ,
      LENS_BUS_HZ => LENS_BUS_HZ,
      ADDRESS     => HOST_ADDRESS,
      HOLD_S      => HOST_HOLD_S,
      TIMEOUT_S   => HOST_TIMEOUT_S
    )
    port map (
      clk          => clk,
      reset        => reset,
      scl_in       => host_scl_level,
      sda_in       => host_sda_level,
      sda_low      => host_sda_low,
      sweep        => sweep,
      pulse        => pulse,
      driver       => driver,
      table        => table,
      table_data   => table_data,
      run          => run_level,
      go           => go,
      idle         => idle,
      progress     => progress,
      sweep_faults => sweep_faults,
      error        => failed
    );

  sequencer : entity work.sweep_sequencer
    generic map (
      CLOCK_HZ => CLOCK_HZ,
      TICK_HZ  => TICK_HZ
    )
    port map (
      clk           => clk,
      reset         => reset,
      go            => go,
      sweep         => sweep,
      driver        => driver,
      table         => table,
      table_data    => table_data,
      lens_start    => lens_start,
      lens_register => lens_register,
      lens_value    => lens_value,
      lens_done     => lens_done,
      lens_fault    => lens_fault,
      progress      => progress,
      late          => late
    );

  lens : entity work.i2c_master
    generic map (
      CLOCK_HZ        => CLOCK_HZ,
      BUS_HZ          => LENS_BUS_HZ,
      STRETCH_LIMIT_S => STRETCH_LIMIT_S,
      INPUT_CYCLES    => INPUT_CYCLES
    )
    port map (
      clk              => clk,
      reset            => reset,
      start            => lens_start,
      address          => driver.address,
      register_number  => lens_register,
      value            => lens_value,
      busy             => open,
      done             => lens_done,
      nack             => lens_faults(0),
      stretched        => lens_faults(1),
      stuck            => lens_faults(2),
      arbitration_lost => lens_faults(3),
      scl_in           => lens_scl_level,
      sda_in           => lens_sda_level,
      scl_low          => lens_scl_low,
      sda_low          => lens_sda_low
    );

  trigger_pulse : entity work.trigger_output
    generic map (
      CLOCK_HZ => CLOCK_HZ,
      TICK_HZ  => TICK_HZ
    )
    port map (
      clk        => clk,
      reset      => reset,
      fire       => progress.fire,
      active_low => pulse.active_low,
      width      => pulse.width,
      opto_on    => pulse.opto_on,
      opto_off   => pulse.opto_off,
      active     => trigger_active,
      pin        => trigger
    );

  sync_pulse : entity work.trigger_output
    generic map (
      CLOCK_HZ => CLOCK_HZ,
      TICK_HZ  => TICK_HZ
    )
    port map (
      clk        => clk,
      reset      => reset,
      fire       => progress.fire_sync,
      active_low => '0',
      width      => pulse.width,
      opto_on    => (others => '0'),
      opto_off   => (others => '0'),
      active     => sync_active,
      pin        => sync
    );

end architecture rtl;
