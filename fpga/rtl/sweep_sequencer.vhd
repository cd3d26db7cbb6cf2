-- SPDX-License-Identifier: LGPL-2.1-or-later
-- Copyright (C) 2026 the gst-plugins-dff authors
--
-- The sweep. Each plane has a slot of `period`; plane 0 has `flyback` more. At the start of a slot code A is
-- committed, then code B is staged and committed, the lens settles, and at a fixed time of the slot the trigger is
-- fired; during the exposure code A of the next plane is staged. A driver that takes a code in one write gets it in
-- place of each commit. The lens is never waited for: what is not in place when the trigger is due stops the sweep.

library ieee;
  use ieee.std_logic_1164.all;
  use ieee.numeric_std.all;

library work;
  use work.sweep_types_pkg.all;

entity sweep_sequencer is
  generic (
    CLOCK_HZ : positive := 125_000_000;
    -- Rate of the time unit of all times here: microseconds
    TICK_HZ : positive := 1_000_000
  );
  port (
    clk   : in    std_ulogic;
    reset : in    std_ulogic;
    -- Sweep while '1'; an exposure that has begun is finished
    go : in    std_ulogic;
    -- Words in use; they change after boundary, and while the sequencer is not busy
    sweep  : in    sweep_words_t;
    driver : in    driver_words_t;
    -- Table of planes: data one cycle after read
    table      : out   row_request_t;
    table_data : in    std_ulogic_vector(15 downto 0);
    -- Lens bus
    lens_start    : out   std_ulogic;
    lens_register : out   std_ulogic_vector(7 downto 0);
    lens_value    : out   std_ulogic_vector(7 downto 0);
    lens_done     : in    std_ulogic;
    lens_fault    : in    std_ulogic;
    progress      : out   progress_t;
    -- One cycle: a trigger was not given
    late : out   std_ulogic
  );
end entity sweep_sequencer;

architecture rtl of sweep_sequencer is

  constant TICK_CYCLES : positive := CLOCK_HZ / TICK_HZ;

  -- At rest after a stop, in which an error takes go back
  constant REST_CYCLES : positive := 13;

  type state_t is (
    idle_state, wake_state, fetch_state, stage_low_state, stage_high_state, wait_slot_state, commit_state,
    delay_state, settle_state, ready_state, stop_state
  );

  signal state     : state_t;
  signal at_rest   : std_ulogic;
  signal rest      : natural range 0 to REST_CYCLES - 1;
  signal lens_busy : std_ulogic;

  -- A write has ended well and the sweep goes on, or it does not
  signal written : std_ulogic;
  signal broken  : std_ulogic;

  -- Row of the next slot, and of the slot in hand while its codes are written
  signal fetch   : std_ulogic;
  signal fetched : std_ulogic;
  signal code_a  : std_ulogic_vector(9 downto 0);
  signal delay   : unsigned(15 downto 0);
  signal code_b  : std_ulogic_vector(9 downto 0);
  signal settle  : unsigned(15 downto 0);
  -- Code B is in hand, not code A
  signal second : std_ulogic;
  signal code   : std_ulogic_vector(9 downto 0);

  -- The slot
  signal running      : std_ulogic;
  signal begin_slot   : std_ulogic;
  signal next_flyback : unsigned(15 downto 0);
  signal first        : std_ulogic;
  signal last         : std_ulogic;
  signal exposing     : std_ulogic;
  signal fire_due     : std_ulogic;
  signal expose_due   : std_ulogic;
  signal slot_end     : std_ulogic;
  signal due          : std_ulogic;
  signal fire_now     : std_ulogic;

  -- What of the settling lies before the trigger's leading edge. The row and the words stand still for long before it
  -- is used
  signal settling : unsigned(15 downto 0);

  -- Delay and settling, from the end of a write
  signal waited     : natural range 0 to 2 ** 16 - 1;
  signal wait_cycle : natural range 0 to TICK_CYCLES - 1;

begin

  assert CLOCK_HZ mod TICK_HZ = 0
    report "sweep_sequencer: the clock must be a multiple of the rate of the time unit"
    severity failure;

  at_rest <= '1' when state = idle_state else
             '0';
  fetch   <= '1' when state = fetch_state else
             '0';

  written <= lens_done and go and not lens_fault;
  broken  <= lens_done and (lens_fault or not go);

  code <= code_a when second = '0' else
          code_b;

  -- At the end of the slot before, or with the first code staged, or known if it is not staged
  begin_slot <= slot_end and go when state = wait_slot_state else
                written and not second and not running when state = stage_high_state else
                fetched and go and driver.direct and not running when state = fetch_state else
                '0';

  -- The trigger is given if all is in place when it is due
  due      <= fire_due and go and not exposing;
  fire_now <= due when state = ready_state else
              '0';

  order : entity work.plane_order
    port map (
      clk          => clk,
      reset        => reset,
      at_rest      => at_rest,
      fetch        => fetch,
      fetched      => fetched,
      advance      => begin_slot,
      planes       => sweep.planes,
      triangle     => sweep.triangle,
      flyback      => sweep.flyback,
      plane        => progress.plane,
      downward     => progress.downward,
      first        => first,
      last         => last,
      next_flyback => next_flyback,
      code_a       => code_a,
      delay        => delay,
      code_b       => code_b,
      settle       => settle,
      table_plane  => table.plane,
      table_column => table.column,
      table_read   => table.read,
      table_data   => table_data
    );

  timer : entity work.slot_timer
    generic map (
      CLOCK_HZ => CLOCK_HZ,
      TICK_HZ  => TICK_HZ
    )
    port map (
      clk        => clk,
      running    => running,
      period     => sweep.period,
      flyback    => next_flyback,
      exposure   => sweep.exposure,
      lead       => sweep.lead,
      fire_due   => fire_due,
      expose_due => expose_due,
      slot_end   => slot_end
    );

  advance_sweep : process (clk) is

    procedure write_lens (
      number,
      value : std_ulogic_vector(7 downto 0)
    ) is
    begin

      lens_start    <= '1';
      lens_busy     <= '1';
      lens_register <= number;
      lens_value    <= value;

    end procedure write_lens;

    procedure write_stage (
      low_bits : std_ulogic_vector(1 downto 0)
    ) is
    begin

      write_lens(driver.stage(7 downto 0), low_bits & "000000");
      state <= stage_low_state;

    end procedure write_stage;

    -- The lens moves with the end of this write: to the code that is staged, or to this one

    procedure move_lens (
      direct_code : std_ulogic_vector(9 downto 0)
    ) is
    begin

      if (driver.direct = '1') then
        write_lens(driver.stage(15 downto 8), direct_code(9 downto 2));
      else
        write_lens(driver.commit(7 downto 0), driver.commit(15 downto 8));
      end if;

      state <= commit_state;

    end procedure move_lens;

    -- An exposure that has begun is finished; a gap is given up at once

    procedure stop is
    begin

      state <= stop_state;
      rest  <= 0;

      if (exposing = '0') then
        running <= '0';
      end if;

    end procedure stop;

    procedure stop_late is
    begin

      stop;
      late     <= '1';
      running  <= '0';
      exposing <= '0';

    end procedure stop_late;

  begin

    if rising_edge(clk) then
      lens_start <= '0';
      late       <= '0';

      progress.fire      <= fire_now;
      progress.fire_sync <= expose_due and first and (exposing or fire_now);
      progress.boundary  <= fire_now and last;

      if (lens_done = '1') then
        lens_busy <= '0';
      end if;

      -- Unknown in a simulation until the first row is read
      settling <= (others => '0');
      if (to_01(settle) > sweep.lead) then
        settling <= settle - sweep.lead;
      end if;

      if (state /= delay_state and state /= settle_state) then
        waited     <= 0;
        wait_cycle <= 0;
      elsif (wait_cycle = TICK_CYCLES - 1) then
        waited     <= waited + 1;
        wait_cycle <= 0;
      else
        wait_cycle <= wait_cycle + 1;
      end if;

      case state is

        when idle_state =>

          progress.busy <= '0';
          if (go = '1') then
            progress.busy <= '1';
            state         <= wake_state;
            write_lens(driver.start(7 downto 0), driver.start(15 downto 8));
          end if;

        when wake_state =>

          if (broken = '1') then
            stop;
          elsif (written = '1') then
            state <= fetch_state;
          end if;

        when fetch_state =>

          if (fetched = '1') then
            second <= '0';
            if (go = '0') then
              stop;
            elsif (driver.direct = '0') then
              write_stage(code_a(1 downto 0));
            elsif (running = '1') then
              state <= wait_slot_state;
            else
              move_lens(code_a);
            end if;
          end if;

        when stage_low_state =>

          if (broken = '1') then
            stop;
          elsif (written = '1') then
            state <= stage_high_state;
            write_lens(driver.stage(15 downto 8), code(9 downto 2));
          end if;

        when stage_high_state =>

          if (broken = '1') then
            stop;
          elsif (written = '1') then
            if (second = '1' or running = '0') then
              move_lens(code);
            else
              state <= wait_slot_state;
            end if;
          end if;

        when wait_slot_state =>

          if (go = '0') then
            stop;
          elsif (slot_end = '1') then
            move_lens(code_a);
          end if;

        when commit_state =>

          if (broken = '1') then
            stop;
          elsif (written = '1') then
            if (second = '0') then
              state <= delay_state;
            elsif (settling /= 0) then
              state <= settle_state;
            else
              state <= ready_state;
            end if;
          end if;

        when delay_state =>

          if (go = '0') then
            stop;
          elsif (waited = delay) then
            second <= '1';
            if (driver.direct = '1') then
              move_lens(code_b);
            else
              write_stage(code_b(1 downto 0));
            end if;
          end if;

        when settle_state =>

          if (go = '0') then
            stop;
          elsif (waited = settling) then
            state <= ready_state;
          end if;

        when ready_state =>

          if (go = '0') then
            stop;
          end if;

        when stop_state =>

          if (running = '0' and lens_busy = '0') then
            if (rest = REST_CYCLES - 1) then
              state <= idle_state;
            else
              rest <= rest + 1;
            end if;
          end if;

      end case;

      if (begin_slot = '1') then
        running  <= '1';
        exposing <= '0';
      end if;

      if (fire_now = '1') then
        exposing <= '1';
        state    <= fetch_state;
      elsif (due = '1' and state /= ready_state and state /= stop_state) then
        stop_late;
      end if;

      if (slot_end = '1' and (state /= wait_slot_state or go = '0')) then
        running  <= '0';
        exposing <= '0';
        if (state /= wait_slot_state and state /= stop_state) then
          stop_late;
        end if;
      end if;

      if (reset = '1') then
        state      <= idle_state;
        second     <= '0';
        running    <= '0';
        exposing   <= '0';
        lens_busy  <= '0';
        lens_start <= '0';
        late       <= '0';

        progress.busy      <= '0';
        progress.fire      <= '0';
        progress.fire_sync <= '0';
        progress.boundary  <= '0';
      end if;
    end if;

  end process advance_sweep;

end architecture rtl;
