# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""A model of the host's I2C controller: SMBus words and blocks, I2C blocks, and transfers that a driver gets wrong."""

from cocotb.triggers import Timer


class Nack(Exception):
    """The sequencer did not acknowledge the byte with this number (the address is 0)."""


class I2cHost:
    """Drives scl_low and sda_low; reads sda. bit_ps: length of a bit."""

    def __init__(self, scl_low, sda_low, sda, bit_ps, address=0x3C):
        self.scl_low, self.sda_low, self.sda = scl_low, sda_low, sda
        self.quarter = bit_ps // 4
        self.address = address
        scl_low.value = 0
        sda_low.value = 0

    async def _wait(self, quarters=1):
        await Timer(self.quarter * quarters, unit="ps")

    async def start(self):
        self.sda_low.value = 0
        await self._wait()
        self.scl_low.value = 0
        await self._wait()
        self.sda_low.value = 1
        await self._wait()
        self.scl_low.value = 1
        await self._wait()

    async def stop(self):
        self.sda_low.value = 1
        await self._wait()
        self.scl_low.value = 0
        await self._wait()
        self.sda_low.value = 0
        await self._wait(2)

    async def bit(self, value):
        """One clock; gives the level seen on SDA."""
        self.sda_low.value = 1 - value
        await self._wait()
        self.scl_low.value = 0
        await self._wait(2)
        level = int(self.sda.value)
        self.scl_low.value = 1
        await self._wait()
        return level

    async def send(self, byte):
        """Gives True if it was acknowledged."""
        for index in range(7, -1, -1):
            await self.bit(byte >> index & 1)
        return await self.bit(1) == 0

    async def receive(self, acknowledge):
        byte = 0
        for _ in range(8):
            byte = byte << 1 | await self.bit(1)
        await self.bit(0 if acknowledge else 1)
        return byte

    async def write_bytes(self, data):
        """Start, address, data, stop."""
        await self.start()
        for number, byte in enumerate([self.address << 1, *data]):
            if not await self.send(byte):
                await self.stop()
                raise Nack(number)
        await self.stop()

    async def read_bytes(self, command, count):
        """The bytes after a repeated start; count may be a function of the first byte."""
        await self.start()
        for number, byte in enumerate([self.address << 1, command]):
            if not await self.send(byte):
                await self.stop()
                raise Nack(number)
        await self.start()
        if not await self.send(self.address << 1 | 1):
            await self.stop()
            raise Nack(0)
        data = []
        if callable(count):
            data.append(await self.receive(True))
            count = 1 + count(data[0])
        while len(data) < count:
            data.append(await self.receive(len(data) + 1 < count))
        await self.stop()
        return data

    async def write_word(self, word, value):
        await self.write_bytes([word, value & 0xFF, value >> 8])

    async def read_word(self, word):
        low, high = await self.read_bytes(word, 2)
        return high << 8 | low

    async def write_block(self, word, values):
        """SMBus block: with its byte count."""
        data = [byte for value in values for byte in (value & 0xFF, value >> 8)]
        await self.write_bytes([0x80 | word, len(data), *data])

    async def read_block(self, word):
        data = await self.read_bytes(0x80 | word, lambda count: count)
        return [low | high << 8 for low, high in zip(data[1::2], data[2::2])]

    async def write_words(self, word, values):
        """I2C block: words one after the other, without a count."""
        await self.write_bytes([word, *(byte for value in values for byte in (value & 0xFF, value >> 8))])
