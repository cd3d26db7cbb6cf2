-- SPDX-License-Identifier: LGPL-2.1-or-later
-- Copyright (C) 2026 the gst-plugins-dff authors
--
-- The sweep. Each plane has a slot of `period`; plane 0 has `flyback` more. At the start of a slot code A is
-- committed, then code B is staged and committed, the lens settles, and at a fixed time of the slot the trigger is
-- fired; during the exposure code A of the next plane is staged. The lens is never waited for: what is not in place
-- when the trigger is due stops the sweep.

library ieee;
  use ieee.std_logic_1164.all;
  use ieee.numeric_std.all;

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
    planes          : in    unsigned(6 downto 0);
    triangle        : in    std_ulogic;
    period          : in    unsigned(15 downto 0);
    exposure        : in    unsigned(15 downto 0);
    flyback         : in    unsigned(15 downto 0);
    lead            : in    unsigned(7 downto 0);
    start_write     : in    std_ulogic_vector(15 downto 0);
    stage_registers : in    std_ulogic_vector(15 downto 0);
    commit_write    : in    std_ulogic_vector(15 downto 0);
    -- Table of planes: data one cycle after read
    table_plane  : out   unsigned(5 downto 0);
    table_column : out   unsigned(1 downto 0);
    table_read   : out   std_ulogic;
    table_data   : in    std_ulogic_vector(15 downto 0);
    -- Lens bus
    lens_start    : out   std_ulogic;
    lens_register : out   std_ulogic_vector(7 downto 0);
    lens_value    : out   std_ulogic_vector(7 downto 0);
    lens_done     : in    std_ulogic;
    lens_fault    : in    std_ulogic;
    -- One cycle each: trigger pulse, sync pulse (first plane of a sweep), last trigger of a sweep, trigger not given
    fire      : out   std_ulogic;
    fire_sync : out   std_ulogic;
    boundary  : out   std_ulogic;
    late      : out   std_ulogic;
    busy      : out   std_ulogic;
    plane     : out   unsigned(5 downto 0);
    downward  : out   std_ulogic
  );
end entity sweep_sequencer;

architecture rtl of sweep_sequencer is

  constant TICK_CYCLES : positive := CLOCK_HZ / TICK_HZ;

  -- Steps of fetch_state: the table is exchanged, the next plane chosen, its four words read
  constant CHOOSE_STEP  : positive := 6;
  constant READ_LATENCY : positive := 2;
  constant LAST_STEP    : positive := CHOOSE_STEP + READ_LATENCY + 4;

  -- Time in a slot, as long as it can get: period and flyback

  subtype time_t is natural range 0 to 2 ** 17 - 1;

  type state_t is (
    idle_state, wake_state, fetch_state, stage_low_state, stage_high_state, wait_slot_state, commit_state,
    delay_state, settle_state, ready_state, stop_state
  );

  signal state : state_t;
  signal step  : natural range 0 to LAST_STEP + 1;
  -- Code B is in hand, not code A
  signal second     : std_ulogic;
  signal code_a     : std_ulogic_vector(9 downto 0);
  signal code_b     : std_ulogic_vector(9 downto 0);
  signal delay      : unsigned(15 downto 0);
  signal settle     : unsigned(15 downto 0);
  signal code       : std_ulogic_vector(9 downto 0);
  signal lens_busy  : std_ulogic;
  signal standstill : std_ulogic;

  -- Plane of the next slot
  signal next_plane     : unsigned(5 downto 0);
  signal next_first     : std_ulogic;
  signal next_downward  : std_ulogic;
  signal next_flyback   : unsigned(15 downto 0);
  signal next_length    : time_t;
  signal next_expose_at : time_t;
  signal next_fire_at   : time_t;

  -- The slot: running, from its start
  signal running       : std_ulogic;
  signal exposing      : std_ulogic;
  signal first         : std_ulogic;
  signal slot_time     : time_t;
  signal slot_prescale : natural range 0 to TICK_CYCLES - 1;
  signal last_tick     : time_t;
  signal expose_at     : time_t;
  signal fire_at       : time_t;

  -- Delay and settling, from the end of a write
  signal wait_time     : time_t;
  signal wait_prescale : natural range 0 to TICK_CYCLES - 1;

begin

  assert CLOCK_HZ mod TICK_HZ = 0
    report "sweep_sequencer: the clock must be a multiple of the rate of the time unit"
    severity failure;

  table_plane <= next_plane;

  code <= code_a when second = '0' else
          code_b;

  -- Fixed times of the next slot; the words they come from stand still for long before they are taken over.
  -- Modulo 2**17: a table that has not passed the check must not end a simulation
  next_flyback   <= flyback when next_first = '1' and (triangle = '0' or standstill = '1') else
                    (others => '0');
  next_length    <= to_integer(resize(period, 17) + next_flyback);
  next_expose_at <= to_integer(to_unsigned(next_length, 17) - exposure);
  next_fire_at   <= to_integer(to_unsigned(next_expose_at, 17) - lead);

  sweep : process (clk) is

    variable slot_end : boolean;
    variable last     : boolean;
    variable fire_now : boolean;

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

    procedure write_commit is
    begin

      write_lens(commit_write(7 downto 0), commit_write(15 downto 8));
      state <= commit_state;

    end procedure write_commit;

    -- An exposure that has begun is finished; a gap is given up at once

    procedure stop is
    begin

      state <= stop_state;
      step  <= 0;

      if (exposing = '0') then
        running <= '0';
      end if;

    end procedure stop;

    procedure stop_late is
    begin

      late     <= '1';
      state    <= stop_state;
      step     <= 0;
      running  <= '0';
      exposing <= '0';

    end procedure stop_late;

    procedure begin_slot is
    begin

      running       <= '1';
      exposing      <= '0';
      standstill    <= '0';
      slot_time     <= 0;
      slot_prescale <= 0;
      last_tick     <= next_length - 1;
      expose_at     <= next_expose_at;
      fire_at       <= next_fire_at;
      plane         <= next_plane;
      first         <= next_first;
      downward      <= next_downward;
      second        <= '0';
      write_commit;

    end procedure begin_slot;

    procedure wait_for (
      time_units : unsigned(15 downto 0);
      next_state : state_t
    ) is
    begin

      wait_time     <= to_integer(time_units);
      wait_prescale <= 0;
      state         <= next_state;

    end procedure wait_for;

    procedure count_wait is
    begin

      if (wait_prescale = TICK_CYCLES - 1) then
        wait_prescale <= 0;
        wait_time     <= wait_time - 1;
      else
        wait_prescale <= wait_prescale + 1;
      end if;

    end procedure count_wait;

    procedure choose_plane is
    begin

      if (next_first = '1') then
        next_downward <= triangle and not downward and not standstill;
        if (triangle = '1' and downward = '0' and standstill = '0') then
          next_plane <= resize(planes - 1, 6);
        else
          next_plane <= (others => '0');
        end if;
      elsif (downward = '1') then
        next_plane <= plane - 1;
      else
        next_plane <= plane + 1;
      end if;

    end procedure choose_plane;

  begin

    if rising_edge(clk) then
      lens_start <= '0';
      table_read <= '0';
      fire       <= '0';
      fire_sync  <= '0';
      boundary   <= '0';
      late       <= '0';

      -- Time of the slot
      slot_end := running = '1' and slot_time = last_tick and slot_prescale = TICK_CYCLES - 1;
      if (running = '1') then
        if (slot_prescale = TICK_CYCLES - 1) then
          slot_prescale <= 0;
          slot_time     <= slot_time + 1;
        else
          slot_prescale <= slot_prescale + 1;
        end if;
      end if;

      if (lens_done = '1') then
        lens_busy <= '0';
      end if;

      case state is

        when idle_state =>

          busy       <= '0';
          downward   <= '0';
          standstill <= '1';
          next_first <= '1';
          if (go = '1') then
            busy  <= '1';
            state <= wake_state;
            write_lens(start_write(7 downto 0), start_write(15 downto 8));
          end if;

        when wake_state =>

          step <= 0;
          if (lens_done = '1') then
            state <= fetch_state;
            if (lens_fault = '1' or go = '0') then
              stop;
            end if;
          end if;

        when fetch_state =>

          step <= step + 1;
          if (step = CHOOSE_STEP - 1) then
            choose_plane;
          end if;
          if (step >= CHOOSE_STEP and step < CHOOSE_STEP + 4) then
            table_column <= to_unsigned(step - CHOOSE_STEP, 2);
            table_read   <= '1';
          end if;

          case step - CHOOSE_STEP - READ_LATENCY is

            when 0 =>

              code_a <= table_data(9 downto 0);

            when 1 =>

              delay <= unsigned(table_data);

            when 2 =>

              code_b <= table_data(9 downto 0);

            when 3 =>

              settle <= unsigned(table_data);

            when others =>

              null;

          end case;

          if (step = LAST_STEP) then
            second <= '0';
            state  <= stage_low_state;
            if (go = '0') then
              stop;
            else
              write_lens(stage_registers(7 downto 0), code_a(1 downto 0) & "000000");
            end if;
          end if;

        when stage_low_state =>

          if (lens_done = '1') then
            if (lens_fault = '1' or go = '0') then
              stop;
            else
              state <= stage_high_state;
              write_lens(stage_registers(15 downto 8), code(9 downto 2));
            end if;
          end if;

        when stage_high_state =>

          if (lens_done = '1') then
            if (lens_fault = '1' or go = '0') then
              stop;
            elsif (second = '1') then
              write_commit;
            elsif (running = '1') then
              state <= wait_slot_state;
            else
              begin_slot;
            end if;
          end if;

        when wait_slot_state =>

          if (go = '0') then
            stop;
          elsif (slot_end) then
            begin_slot;
          end if;

        when commit_state =>

          if (lens_done = '1') then
            if (lens_fault = '1' or go = '0') then
              stop;
            elsif (second = '0') then
              wait_for(delay, delay_state);
            elsif (settle > lead) then
              wait_for(settle - lead, settle_state);
            else
              state <= ready_state;
            end if;
          end if;

        when delay_state =>

          if (go = '0') then
            stop;
          elsif (wait_time = 0) then
            second <= '1';
            state  <= stage_low_state;
            write_lens(stage_registers(7 downto 0), code_b(1 downto 0) & "000000");
          else
            count_wait;
          end if;

        when settle_state =>

          if (go = '0') then
            stop;
          elsif (wait_time = 0) then
            state <= ready_state;
          else
            count_wait;
          end if;

        when ready_state =>

          if (go = '0') then
            stop;
          end if;

        when stop_state =>

          -- Some cycles at rest, in which an error takes go back
          if (running = '0' and lens_busy = '0') then
            step <= step + 1;
            if (step = LAST_STEP) then
              state <= idle_state;
            end if;
          end if;

      end case;

      -- The two fixed times of the slot: the trigger leaves, and (behind the opto-isolator) the exposure starts
      fire_now := running = '1' and slot_time = fire_at and slot_prescale = 0 and exposing = '0';
      if (fire_now and state = ready_state and go = '1') then
        fire       <= '1';
        exposing   <= '1';
        state      <= fetch_state;
        step       <= 0;
        last       := (downward = '0' and plane = planes - 1) or (downward = '1' and plane = 0);
        next_first <= '0';
        if (last) then
          boundary   <= '1';
          next_first <= '1';
        end if;
      elsif (fire_now and state /= stop_state and go = '1') then
        stop_late;
      end if;

      if (running = '1' and slot_time = expose_at and slot_prescale = 0 and first = '1') then
        if (exposing = '1' or (fire_now and state = ready_state and go = '1')) then
          fire_sync <= '1';
        end if;
      end if;

      if (slot_end and state /= wait_slot_state) then
        running  <= '0';
        exposing <= '0';
        if (state /= stop_state) then
          stop_late;
        end if;
      elsif (slot_end and go = '0') then
        running  <= '0';
        exposing <= '0';
      end if;

      if (reset = '1') then
        state        <= idle_state;
        busy         <= '0';
        downward     <= '0';
        plane        <= (others => '0');
        next_plane   <= (others => '0');
        table_column <= "00";
        table_read   <= '0';
        second       <= '0';
        next_first   <= '1';
        first        <= '0';
        standstill   <= '1';
        running      <= '0';
        exposing     <= '0';
        lens_busy    <= '0';
        lens_start   <= '0';
        fire         <= '0';
        fire_sync    <= '0';
        late         <= '0';
        boundary     <= '0';
      end if;
    end if;

  end process sweep;

end architecture rtl;
