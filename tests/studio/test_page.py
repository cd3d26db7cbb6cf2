#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""The page of dff-studio in a headless Chromium, as a user has it. With DFF_STUDIO_SHOTS=FOLDER, screenshots stay there."""
import os
import pathlib
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import unittest

import numpy as np

from studio_process import PATIENCE, SWEEP, Studio, rig

try:
    from selenium import webdriver
    from selenium.common.exceptions import WebDriverException
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.by import By
except ImportError:
    print('There is no python3-selenium: skipped')
    sys.exit(77)
CHROMIUM, DRIVER = shutil.which('chromium'), shutil.which('chromedriver')
if not CHROMIUM or not DRIVER:
    print('There is no chromium or no chromium-driver: skipped')
    sys.exit(77)

# Chromium looks for a way to the server only where there is a network beside the loopback.
NETWORK = ('ip link add studio0 type veth peer name studio1', 'ip addr add 10.9.0.1/24 dev studio0', 'ip link set studio0 up',
           'ip link set studio1 up', 'ip route add default dev studio0')
# Pictures as the page shows them, made small; the relief is drawn anew before, since what it has drawn is gone with the frame.
PIXELS = '''
const source = document.getElementById(arguments[0]), small = document.createElement('canvas');
Object.assign(small, { width: 48, height: 36 });
if (arguments[0] === 'relief') document.getElementById('height').dispatchEvent(new Event('input'));
const context = small.getContext('2d');
context.drawImage(source, 0, 0, 48, 36);
return Array.from(context.getImageData(0, 0, 48, 36).data);
'''


class Browser:
    def __init__(self, folder):
        options = webdriver.ChromeOptions()
        options.binary_location = CHROMIUM
        for argument in ('--headless=new', '--no-sandbox', '--disable-dev-shm-usage', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
                         '--disable-background-networking', '--no-first-run', '--window-size=1440,960', f'--user-data-dir={folder}/profile'):
            options.add_argument(argument)
        options.add_experimental_option('prefs', {
            'download.default_directory': f'{folder}/saved', 'download.prompt_for_download': False,
            'profile.default_content_setting_values.automatic_downloads': 1})  # more than one, without a hand on the mouse
        options.set_capability('goog:loggingPrefs', {'browser': 'ALL'})
        self.driver = webdriver.Chrome(options=options, service=Service(DRIVER))
        self.driver.set_script_timeout(PATIENCE)
        self.saved = pathlib.Path(folder, 'saved')

    def run(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def until(self, script, *arguments):
        """What the script gives when it gives something."""
        end = time.monotonic() + PATIENCE
        while not (found := self.run(script, *arguments)):
            if time.monotonic() > end:
                raise AssertionError(f'{script} stays {found}; the page says {self.run("return document.body.innerText")}; '
                                     f'{self.driver.get_log("browser")}')
            time.sleep(0.2)
        return found

    def text(self, name):
        return self.run('return document.getElementById(arguments[0]).textContent', name)

    def pixels(self, name):
        return np.array(self.run(PIXELS, name)).reshape(36, 48, 4)[:, :, :3].astype(float)

    def is_playing(self):
        before = self.until('return picture.videoWidth && depth.videoWidth && [picture.currentTime, depth.currentTime]')
        self.until('return picture.currentTime > arguments[0] && depth.currentTime > arguments[1]', *before)

    def click(self, selector):
        self.run('document.querySelector(arguments[0]).click()', selector)

    def set(self, name, value):
        """The control of a property, as a user's hand sets it."""
        self.run('''const row = document.querySelector(`[data-property=${arguments[0]}]`);
                    const input = row.querySelector('select, input[type=number]') ?? row.querySelector('input');
                    if (input.type === 'checkbox') input.checked = arguments[1]; else input.value = arguments[1];
                    input.dispatchEvent(new Event('change'));''', name, value)

    def press(self, key):
        self.run('document.body.dispatchEvent(new KeyboardEvent("keydown", { key: arguments[0], bubbles: true }))', key)

    def click_at(self, x, y):
        """A place of the picture, in parts of it."""
        self.run('''const box = picture.getBoundingClientRect(), where = { clientX: box.left + arguments[0] * box.width,
                    clientY: box.top + arguments[1] * box.height, pointerId: 1, bubbles: true };
                    picture.setPointerCapture = () => {};
                    for (const kind of ['pointermove', 'pointerdown', 'pointerup']) picture.dispatchEvent(new PointerEvent(kind, where));''', x, y)

    def drag(self, x0, y0, x1, y1):
        self.run('''const box = picture.getBoundingClientRect();
                    picture.setPointerCapture = () => {};
                    for (const [kind, x, y] of [['pointerdown', arguments[0], arguments[1]], ['pointermove', arguments[2], arguments[3]],
                                                ['pointerup', arguments[2], arguments[3]]])
                      picture.dispatchEvent(new PointerEvent(kind, { clientX: box.left + x * box.width, clientY: box.top + y * box.height, pointerId: 1 }));''',
                 x0, y0, x1, y1)

    def file(self, ending):
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            for path in self.saved.glob(f'*{ending}'):
                return path.read_bytes()
            time.sleep(0.1)
        raise AssertionError(f'{ending} was not saved: {list(self.saved.glob("*"))}, {self.text("problem")}')

    def shoot(self, name):
        if folder := os.environ.get('DFF_STUDIO_SHOTS'):
            for _ in range(5):
                try:
                    return self.driver.save_screenshot(f'{folder}/{name}.png')
                except WebDriverException:  # takes its time where the processor draws
                    time.sleep(1)
        return None


def has_network():
    return 'studio0' in [name for _, name in socket.if_nameindex()]


def connect_network():
    if not has_network():
        for command in NETWORK:
            subprocess.run(command.split(), check=True)


def browser_of(test):
    """A browser until the test is over."""
    folder = tempfile.TemporaryDirectory()
    test.addCleanup(folder.cleanup)
    browser = Browser(folder.name)
    test.addCleanup(browser.driver.quit)
    return browser


class Alone(unittest.TestCase):
    """First, before there is any network."""

    def test_page_says_that_the_video_finds_no_way(self):
        self.assertFalse(has_network())
        browser = browser_of(self)
        with Studio('--launch', rig()) as studio:
            browser.driver.get(f'http://localhost:{studio.port}/')
            browser.until('return /finds no way/.test(state.textContent)')
            connect_network()
            browser.driver.refresh()  # Chromium looks for networks once a page
            browser.is_playing()
            browser.until('return state.textContent === "live"')


class OtherSources(unittest.TestCase):
    def test_what_a_source_does_not_give_is_told_and_not_asked_for(self):
        connect_network()
        planes = SWEEP.format('is-live=true rate=2')
        browser = browser_of(self)
        for launch, video, absent in ((planes + ' ! focalstackmux ! dffdepth name=depth', 'depth', 'no-picture'),
                                      (planes + ' ! identity name=planes', 'picture', 'no-depth')):
            with Studio('--launch', launch) as studio:
                browser.driver.get(f'http://localhost:{studio.port}/')
                browser.until('return window[arguments[0]].currentTime > 1', video)
                hidden = browser.run('return [...document.querySelectorAll(".absent[hidden]")].map(note => note.id)')
                self.assertEqual({'no-picture', 'no-depth', 'no-relief'} - set(hidden), {absent})
                browser.click_at(0.5, 0.5)
                browser.drag(0.1, 0.5, 0.9, 0.5)
                browser.press('4')
                browser.click('#freeze')
                browser.until('return freeze.textContent === "Go on"')
                self.assertTrue(browser.run('return problem.hidden'), browser.text('problem'))


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        connect_network()
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.source = rig(os.environ.get('DFF_STUDIO_SOURCE', 'is-live=true rate=4'))
        cls.studio = Studio('--launch', cls.source)
        cls.addClassCleanup(lambda: cls.studio.end())
        cls.browser = Browser(folder.name)
        cls.addClassCleanup(cls.browser.driver.quit)
        cls.browser.driver.get(f'http://localhost:{cls.studio.port}/')

    def setUp(self):
        self.browser.is_playing()

    def changed(self, name, before):
        return np.abs(self.browser.pixels(name) - before).mean()

    def wait(self, ready, otherwise):
        end = time.monotonic() + PATIENCE
        while not ready():
            self.assertLess(time.monotonic(), end, otherwise)
            time.sleep(0.3)

    def test_1_both_videos_show_the_scene(self):
        self.assertEqual(self.browser.text('state'), 'live')
        picture, depth = self.browser.pixels('picture'), self.browser.pixels('depth')
        self.assertGreater(picture.std(), 15)
        self.assertGreater(np.ptp(depth, axis=2).mean(), 120)  # hues
        self.browser.until('return rate.textContent > 0 && /ms/.test(latency.textContent) && lost.textContent === "0"')
        self.assertIn('near 5.000 – far 0.500 dpt', self.browser.until('return range.textContent'))
        self.browser.shoot('live-1440')

    def test_2_property_set_on_the_page_changes_depth_and_relief(self):
        self.wait(lambda: self.browser.pixels('relief').std() > 8, 'there is no relief')
        relief, depth = self.browser.pixels('relief'), self.browser.pixels('depth')
        time.sleep(1)
        still = self.changed('relief', relief)
        self.browser.set('scene', 'slant')
        self.wait(lambda: self.changed('relief', relief) > 2 + 3 * still and self.changed('depth', depth) > 12, 'the relief stays as it was')
        self.browser.run('location.reload()')  # what it shows now comes from the element
        self.browser.is_playing()
        self.assertEqual(self.browser.until('return document.querySelector("[data-property=scene] select")?.value'), 'slant')
        self.browser.set('scene', 'shapes')
        self.browser.set('tolerance', 900)
        self.browser.until('return /tolerance lies between/.test(problem.textContent)')  # which is hidden again after some seconds
        self.browser.until('return document.querySelector("[data-property=scene] select").value === "shapes"')

    def test_3_relief_turns(self):
        self.browser.click('#freeze')
        self.browser.until('return freeze.textContent === "Go on"')
        before = self.browser.pixels('relief')
        np.testing.assert_array_equal(self.browser.pixels('relief'), before)
        self.browser.run('''for (const [kind, x] of [['pointerdown', 100], ['pointermove', 260], ['pointerup', 260]])
                              { relief.setPointerCapture = () => {}; relief.dispatchEvent(new PointerEvent(kind, { clientX: x, clientY: 50, pointerId: 1 })); }''')
        self.assertGreater(self.changed('relief', before), 2)
        self.browser.shoot('frozen-1440')
        self.browser.click('#freeze')
        self.browser.until('return freeze.textContent === "Freeze"')

    def test_4_point_line_and_planes(self):
        self.browser.click_at(0.5, 0.5)
        self.browser.until('return /dpt|not known/.test(readout.textContent) && /confidence/.test(readout.textContent)')
        peak = float(self.browser.until('return peak.dataset.peak'))
        self.assertTrue(0 <= peak <= 5)
        self.browser.until('return sharpness.querySelectorAll(".dot").length === 6 && plane.naturalWidth === 160')
        self.browser.shoot('planes-1440')
        self.browser.drag(0.1, 0.5, 0.9, 0.5)
        self.browser.until('return document.querySelector("#profile-plot .curve")?.getAttribute("d").length > 100')
        self.browser.press('4')
        self.browser.until('return histogram.querySelectorAll(".bar").length === 64')
        for name in ('confidence', 'motion'):
            self.browser.press('o')
            self.assertEqual(self.browser.run('return overlay.value'), name)
            self.browser.until('return document.querySelector(".overlay").width === 160')
        self.browser.press('o')
        self.browser.press('1')

    def test_5_saves(self):
        for name, magic in (('picture.png', b'\x89PNG'), ('frame.exr', b'\x76\x2f\x31\x01'), ('cloud.ply', b'ply\n')):
            self.browser.click(f'[data-file="{name}"]')
            self.assertTrue(self.browser.file(name).startswith(magic))
        self.assertEqual(self.browser.text('freeze'), 'Freeze')
        self.browser.click('[data-file="depth.png"]')  # while the next one is asked for
        self.browser.click('[data-file="picture.png"]')
        self.browser.file('depth.png')
        self.assertEqual(self.browser.text('freeze'), 'Freeze')
        self.browser.click('#record')
        self.browser.until('return /Stop, [1-9]/.test(record.textContent)')
        self.browser.click('#record')
        self.assertTrue(self.browser.file('recording.mkv').startswith(b'\x1aE\xdf\xa3'))

    def test_6_tablet(self):
        self.browser.driver.set_window_size(800, 1180)
        self.browser.is_playing()
        self.assertLessEqual(self.browser.run('return document.documentElement.scrollWidth'), 800)
        self.browser.shoot('live-800')
        self.browser.driver.set_window_size(1440, 960)

    def test_7_second_browser_joins(self):
        first = self.browser.driver.current_window_handle
        self.browser.driver.switch_to.new_window('window')
        self.browser.driver.get(f'http://localhost:{self.studio.port}/')
        self.browser.is_playing()
        self.browser.click('[data-panel=counts]')
        self.browser.until('return /looking\\s*2/.test(counts.textContent)')
        self.browser.driver.close()
        self.browser.driver.switch_to.window(first)
        self.browser.is_playing()

    def test_8_server_restarts(self):
        port = self.studio.port
        self.studio.end()
        self.browser.until('return /gone/.test(state.textContent) && rate.textContent === "–"')
        for button in ('[data-file="picture.png"]', '#freeze', '#record'):
            self.browser.run('problem.hidden = true')
            self.browser.click(button)
            self.browser.until('return !problem.hidden && /gone/.test(problem.textContent)')
        type(self).studio = Studio('--launch', self.source, port=port)
        self.browser.until('return state.textContent === "live"')
        self.browser.is_playing()
        errors = [entry for entry in self.browser.driver.get_log('browser') if entry['level'] == 'SEVERE' and 'WebSocket' not in entry['message']]
        self.assertEqual(errors, [])

    def test_9_lost_video_is_told(self):
        self.browser.run('''let packets = 0;
                            RTCPeerConnection.prototype.getStats = async () => (packets += 100, new Map([[0,
                              { type: 'inbound-rtp', framesDecoded: packets, packetsReceived: packets, packetsLost: packets / 4 }]]));''')
        self.browser.until('return /^20 % of the video is lost/.test(state.textContent)')


if __name__ == '__main__':
    unittest.main(argv=['test_page.py', *sys.argv[1:]], failfast='-f' in sys.argv)
