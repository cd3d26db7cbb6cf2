-- SPDX-License-Identifier: LGPL-2.1-or-later
-- Copyright (C) 2026 the gst-plugins-dff authors
--
-- The order of the planes: knows the plane of the slot in hand, chooses that of the next one and reads its row of the
-- table.

library ieee;
  use ieee.std_logic_1164.all;
  use ieee.numeric_std.all;

entity plane_order is
  port (
    clk   : in    std_ulogic;
    reset : in    std_ulogic;
    -- The next slot will be the first one of a first sweep
    at_rest : in    std_ulogic;
    -- '1' until the next slot is known; fetched comes with the last cycle
    fetch   : in    std_ulogic;
    fetched : out   std_ulogic;
    -- One cycle: the next slot is now the one in hand
    advance : in    std_ulogic;
    -- Words in use
    planes   : in    unsigned(6 downto 0);
    triangle : in    std_ulogic;
    flyback  : in    unsigned(15 downto 0);
    -- The slot in hand: its plane, and whether it is the first or the last one of its sweep
    plane    : out   unsigned(5 downto 0);
    downward : out   std_ulogic;
    first    : out   std_ulogic;
    last     : out   std_ulogic;
    -- The next slot: its extra time, and its row
    next_flyback : out   unsigned(15 downto 0);
    code_a       : out   std_ulogic_vector(9 downto 0);
    delay        : out   unsigned(15 downto 0);
    code_b       : out   std_ulogic_vector(9 downto 0);
    settle       : out   unsigned(15 downto 0);
    -- Table: data one cycle after read
    table_plane  : out   unsigned(5 downto 0);
    table_column : out   unsigned(1 downto 0);
    table_read   : out   std_ulogic;
    table_data   : in    std_ulogic_vector(15 downto 0)
  );
end entity plane_order;

architecture rtl of plane_order is

  -- With a new sweep the tables are exchanged, then the plane is chosen, its four words are asked for and come
  constant CHOOSE_STEP : natural := 5;
  constant READ_STEP   : natural := CHOOSE_STEP + 1;
  constant DATA_STEP   : natural := READ_STEP + 2;
  constant LAST_STEP   : natural := DATA_STEP + 4;

  signal step          : natural range 0 to LAST_STEP;
  signal standstill    : std_ulogic;
  signal next_plane    : unsigned(5 downto 0);
  signal next_first    : std_ulogic;
  signal next_downward : std_ulogic;

begin

  fetched     <= '1' when step = LAST_STEP else
                 '0';
  last        <= '1' when (downward = '0' and plane = planes - 1) or (downward = '1' and plane = 0) else
                 '0';
  table_plane <= next_plane;

  -- The way back to plane 0 takes time; within a triangle there is none
  next_flyback <= flyback when next_first = '1' and (triangle = '0' or standstill = '1') else
                  (others => '0');

  follow : process (clk) is
  begin

    if rising_edge(clk) then
      if (at_rest = '1') then
        standstill <= '1';
        downward   <= '0';
      elsif (advance = '1') then
        standstill <= '0';
        plane      <= next_plane;
        first      <= next_first;
        downward   <= next_downward;
      end if;

      if (reset = '1') then
        standstill <= '1';
        plane      <= (others => '0');
        first      <= '0';
        downward   <= '0';
      end if;
    end if;

  end process follow;

  choose_and_read : process (clk) is

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

    procedure take_word is
    begin

      case step is

        when DATA_STEP =>

          code_a <= table_data(9 downto 0);

        when DATA_STEP + 1 =>

          delay <= unsigned(table_data);

        when DATA_STEP + 2 =>

          code_b <= table_data(9 downto 0);

        when DATA_STEP + 3 =>

          settle <= unsigned(table_data);

        when others =>

          null;

      end case;

    end procedure take_word;

  begin

    if rising_edge(clk) then
      step       <= 0;
      table_read <= '0';
      if (fetch = '1' and step < LAST_STEP) then
        step <= step + 1;

        if (step = 0) then
          next_first <= last or standstill;
        elsif (step = CHOOSE_STEP) then
          choose_plane;
        elsif (step >= READ_STEP and step < READ_STEP + 4) then
          table_column <= to_unsigned(step - READ_STEP, 2);
          table_read   <= '1';
        end if;
        take_word;
      end if;

      if (reset = '1') then
        step         <= 0;
        next_plane   <= (others => '0');
        next_first   <= '1';
        table_column <= "00";
        table_read   <= '0';
      end if;
    end if;

  end process choose_and_read;

end architecture rtl;
