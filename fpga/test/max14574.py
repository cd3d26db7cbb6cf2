# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Models of the lens drivers MAX14574 and MAX14515 as their bus sees them, and the faults that a real one can have."""

import cocotb
from cocotb.triggers import Timer, ValueChange
from cocotb.utils import get_sim_time

ADDRESS = 0x77
USERMODE, OIS_LSB, LLV4, CMND = 0x03, 0x04, 0x08, 0x09
UPD_OUT, ACTIVE = 0x02, 0x02


class Max14574:
    """Follows the two lines; keeps every byte write with its time, and every code that reached the lens.

    scl, sda: what the bus carries; scl_low, sda_low: what this model pulls.
    writes: (ps of the stop, register, value); codes: (ps, 10-bit code); starts: ps of each start.
    """

    def __init__(self, scl, sda, scl_low, sda_low, address=ADDRESS):
        self.scl, self.sda, self.scl_low, self.sda_low = scl, sda, scl_low, sda_low
        self.address = address
        self.registers = {USERMODE: 0, OIS_LSB: 0, LLV4: 0, CMND: 0}
        self.writes, self.codes, self.starts = [], [], []
        # Faults: number of the transfer (from 0) -> byte not acknowledged, or ps for which SCL is held at byte 0
        self.nack_at, self.stretch_at = {}, {}
        self.payload, self.bits, self.byte, self.held = None, 0, 0, 0
        scl_low.value = 0
        sda_low.value = 0
        cocotb.start_soon(self._follow_scl())
        cocotb.start_soon(self._follow_sda())

    def hold(self, clocks):
        """Holds SDA low, as in a read that was cut off, for this many clocks (None: until release)."""
        self.held = clocks
        self.sda_low.value = 1

    def release(self):
        self.held = 0
        self.sda_low.value = 0

    async def _follow_sda(self):
        """Start and stop: SDA moves while SCL is high."""
        while True:
            await ValueChange(self.sda)
            if self.scl.value == 1:
                if self.sda.value == 0:
                    self.starts.append(get_sim_time("ps"))
                    self.payload, self.bits = [], 0
                else:
                    if self.payload is not None and len(self.payload) == 3:
                        self._write(*self.payload[1:])
                    self.payload = None

    async def _follow_scl(self):
        while True:
            await ValueChange(self.scl)
            if self.held != 0:
                if self.held and self.scl.value == 0:
                    self.held -= 1
                    self.sda_low.value = int(self.held > 0)
            elif self.payload is None:
                self.sda_low.value = 0
            elif self.scl.value == 1:
                self._rise()
            else:
                self._fall()

    def _rise(self):
        if self.bits < 8:
            self.byte = (self.byte << 1 | int(self.sda.value)) & 0xFF
        self.bits += 1

    def _fall(self):
        if self.bits == 8:
            self.payload.append(self.byte)
            number, index = len(self.starts) - 1, len(self.payload) - 1
            if self.payload[0] == self.address << 1 and self.nack_at.get(number) != index:
                self.sda_low.value = 1
            if index == 0 and number in self.stretch_at:
                cocotb.start_soon(self._stretch(self.stretch_at[number]))
        elif self.bits == 9:
            acknowledged = self.sda_low.value == 1
            self.sda_low.value = 0
            self.bits = 0
            if not acknowledged:
                self.payload = None

    async def _stretch(self, duration):
        self.scl_low.value = 1
        await Timer(duration, unit="ps")
        self.scl_low.value = 0

    def _write(self, register, value):
        now = get_sim_time("ps")
        self.writes.append((now, register, value))
        self.registers[register] = value
        if register == CMND and value & UPD_OUT and self.registers[USERMODE] & ACTIVE:
            self.codes.append((now, self.registers[LLV4] << 2 | self.registers[OIS_LSB] >> 6))


class Max14515(Max14574):
    """Takes a code of 8 bits in one write, which moves the lens. codes: (ps, 8-bit code)."""

    POWER_MODE, VOLTAGE, ON = 0x00, 0x01, 0x01

    def __init__(self, *lines):
        super().__init__(*lines, address=0x76)
        self.registers = {self.POWER_MODE: 0, self.VOLTAGE: 0}

    def _write(self, register, value):
        now = get_sim_time("ps")
        self.writes.append((now, register, value))
        self.registers[register] = value
        if register == self.VOLTAGE and self.registers[self.POWER_MODE] & self.ON:
            self.codes.append((now, value))
