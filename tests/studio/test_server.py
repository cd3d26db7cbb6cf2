#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""dff-studio without a browser: what it measures and saves is right, and what it refuses."""
import base64
import pathlib
import socket
import subprocess
import sys
import tempfile
import unittest

import gi
import numpy as np

gi.require_version('Gst', '1.0')
from gi.repository import Gst  # noqa: E402

from studio_process import PATTERNS, ROOT, SWEEP, Socket, Studio, rig, trusting  # noqa: E402

sys.path.insert(0, str(ROOT / 'pipelines/studio'))
from dff_studio import Unusable  # noqa: E402
from dff_studio.frames import rate_of  # noqa: E402
from dff_studio.planes import peak_of  # noqa: E402
from dff_studio.source import Source  # noqa: E402
from dff_studio.studio import Kept  # noqa: E402

Gst.init(None)
AIF = 'videotestsrc is-live=true {} ! video/x-raw,format=I420,width=160,height=120,framerate=10/1 ! identity name=aif '
UPGRADE = {'Connection': 'Upgrade', 'Upgrade': 'websocket', 'Sec-WebSocket-Version': '13', 'Sec-WebSocket-Key': 'AAAAAAAAAAAAAAAAAAAAAA=='}


def true_planes():
    """Plane positions of the simulated scene, from the source's own truth."""
    pipeline = Gst.parse_launch(f'{SWEEP.format("name=t num-buffers=6")} ! fakesink async=false  '
                                't.depth ! queue ! appsink name=truth sync=false')
    pipeline.set_state(Gst.State.PLAYING)
    sample = pipeline.get_by_name('truth').emit('try-pull-sample', 60 * Gst.SECOND)
    pipeline.set_state(Gst.State.NULL)
    buffer = sample.get_buffer()
    codes = np.frombuffer(buffer.extract_dup(0, buffer.get_size()), '<u2').reshape(120, 160)
    return (codes - 1.0) / 65534 * 5


def flat_places(planes):
    """Where the scene is flat around a place, column and row."""
    for row in range(16, 104, 8):
        for column in range(16, 144, 8):
            around = planes[row - 9:row + 10, column - 9:column + 10]
            if np.ptp(around) < 0.3 and 0.6 < around.mean() < 4.4:
                yield column, row, around.mean()


class Measures(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.studio = Studio('--launch', rig())
        cls.addClassCleanup(cls.studio.end)
        cls.socket = Socket(cls.studio)
        cls.hello = cls.socket.expect('hello')

    def freeze(self):
        return self.socket.ask('frozen', type='freeze')

    def load(self, path):
        status, body = self.studio.get(path)
        self.assertEqual(status, 200, body[:200])
        return body

    def depth_of(self, frozen):
        facts = frozen['facts']
        codes = np.frombuffer(self.load(f'/frozen/{frozen["number"]}/depth.bin'), '<u2').reshape(facts['height'], facts['width'])
        return codes, np.where(codes == 0, np.nan, facts['offset'] + facts['scale'] * codes)

    def test_frozen_depth_is_exact_and_pointed_at(self):
        frozen = self.freeze()
        facts = frozen['facts']
        self.assertEqual((facts['unit'], facts['near'], facts['far'], facts['width'], facts['height']), ('dioptre', 5, 0.5, 160, 120))
        codes, dioptres = self.depth_of(frozen)
        self.assertGreater(np.isfinite(dioptres).mean(), 0.9)
        self.assertTrue(0.49 < np.nanmin(dioptres) <= np.nanmax(dioptres) < 5.01)
        found = self.socket.ask('probe', type='probe', x=0.5, y=0.25, frozen=frozen['number'])
        self.assertEqual((found['x'], found['y'], found['pixel']), (80, 30, codes[30, 80]))
        self.assertAlmostEqual(found['value'], dioptres[30, 80])
        self.assertAlmostEqual(found['metres'], 1 / dioptres[30, 80])
        self.assertTrue(0 <= found['confidence'] <= 1 and 0 <= found['motion'] <= 1)
        line = self.socket.ask('profile', type='profile', x0=0, y0=0.5, x1=1, y1=0.5, frozen=frozen['number'])
        np.testing.assert_allclose(np.array(line['values'], float), dioptres[60], equal_nan=True)
        bars = self.socket.ask('histogram', type='histogram', frozen=frozen['number'])
        self.assertEqual(sum(bars['counts']), np.count_nonzero(codes[::2, ::2]))

    def test_sharpness_peaks_at_the_true_plane(self):
        places = list(flat_places(true_planes()))
        self.assertGreater(len(places), 5)
        errors = []
        for column, row, truth in places[::max(1, len(places) // 8)]:
            found = self.socket.ask('planes', type='planes', x=(column + 0.5) / 160, y=(row + 0.5) / 120)
            self.assertEqual((found['planes'], len(found['curve']), found['unit']), (6, 6, 'dpt'))
            self.assertAlmostEqual(found['positions'][0], 5)
            self.assertAlmostEqual(found['at'], np.interp(found['peak'], range(6), found['positions']))
            errors.append(abs(found['peak'] - truth))
        self.assertLess(np.median(errors), 0.35, errors)
        picture = self.load(f'/stack/{found["stack"]}/3.jpg')
        self.assertEqual(picture[:2], b'\xff\xd8')
        self.assertEqual(self.studio.get(f'/stack/{found["stack"]}/6.jpg')[0], 404)

    def test_saved_files_hold_the_frozen_frame(self):
        import OpenImageIO as oiio
        frozen = self.freeze()
        codes, dioptres = self.depth_of(frozen)
        with tempfile.TemporaryDirectory() as folder:
            for name in ('picture.png', 'depth.png', 'frame.exr', 'cloud.ply'):
                pathlib.Path(folder, name).write_bytes(self.load(f'/frozen/{frozen["number"]}/{name}'))
            np.testing.assert_array_equal(oiio.ImageBuf(f'{folder}/depth.png').get_pixels(oiio.UINT16)[:, :, 0], codes)
            picture = oiio.ImageBuf(f'{folder}/picture.png').get_pixels(oiio.UINT8)
            self.assertEqual(picture.shape[:2], (120, 160))
            exr = oiio.ImageBuf(f'{folder}/frame.exr')
            names = exr.spec().channelnames
            metres = exr.get_pixels(oiio.FLOAT)[:, :, names.index('Z')]
            known = codes > 0
            np.testing.assert_allclose(metres[known], 1 / dioptres[known], rtol=1e-4)
            header, _, body = pathlib.Path(folder, 'cloud.ply').read_bytes().partition(b'end_header\n')
        lines = header.decode().splitlines()
        count = next(int(line.split()[2]) for line in lines if line.startswith('element vertex'))
        kinds = {'float': '<f4', 'uchar': 'u1', 'double': '<f8', 'ushort': '<u2'}
        points = np.frombuffer(body, [(line.split()[2], kinds[line.split()[1]]) for line in lines if line.startswith('property')])
        self.assertEqual((len(points), count), (known.sum(), known.sum()))
        np.testing.assert_allclose(np.sort(points['z']), np.sort(1 / dioptres[known]), rtol=1e-4)
        rows, columns = np.nonzero(known)  # rig.yml: 800 pixels of focal length at 640x480, here a quarter
        np.testing.assert_allclose(points['x'], (columns - (319.5 + 0.5) / 4 + 0.5) / 200 / dioptres[known], atol=0.01)
        colours = np.stack([points[name] for name in ('red', 'green', 'blue')], 1)
        np.testing.assert_array_equal(colours, picture[rows, columns, :3])

    def test_properties_are_the_elements_own(self):
        by_factory = {item['factory']: item for item in self.hello['controls']}
        self.assertIn('aifcompose', by_factory)
        maker = by_factory['dffdepth']
        properties = {item['name']: item for item in maker['properties']}
        self.assertEqual(properties['method']['kind'], 'choice')
        self.assertIn('paper', [choice['name'] for choice in properties['method']['choices']])
        self.assertEqual((properties['levels']['least'], properties['levels']['most']), (1, 4))
        self.assertNotIn('calibration', properties)  # a file of this machine is nobody's business

        def value(message, name):
            return next(item['value'] for item in next(element for element in message['controls']
                                                      if element['element'] == maker['element'])['properties'] if item['name'] == name)
        self.socket.send(type='set', element=maker['element'], name='levels', value=3)
        self.socket.expect('controls', lambda message: value(message, 'levels') == 3)
        for name, wrong in (('levels', 9), ('levels', 'much'), ('method', 'magic'), ('device', 'x'), ('name', 'x')):
            self.socket.send(type='set', element=maker['element'], name=name, value=wrong)
            self.assertIn(name, self.socket.expect('problem')['text'])
        self.socket.send(type='nonsense')
        self.socket.expect('problem')

    def test_source_starts_anew_for_what_cannot_change_while_it_runs(self):
        source = next(item for item in self.hello['controls'] if item['factory'] == 'lenssweeptestsrc')
        self.assertFalse(next(item for item in source['properties'] if item['name'] == 'far')['running'])
        for far in (1, 0.5):
            self.socket.send(type='set', element=source['element'], name='far', value=far)
            self.socket.expect('histogram', lambda message: message['facts']['far'] == far)

    def test_health_counts(self):
        health = self.socket.expect('health', lambda message: message['rate'] > 0)
        self.assertGreater(health['latency'], 0)
        self.assertGreater(health['stats']['maker']['stacks'], 0)
        self.assertEqual(next(counts for name, counts in health['stats'].items() if name.startswith('focalstackmux'))['lost'], 0)

    def test_recording_plays_and_holds_depth(self):
        self.socket.expect('health', lambda message: message['rate'] > 0)
        self.socket.send(type='record', on=True)
        self.socket.expect('recording', lambda message: message['on'])
        for _ in range(3):
            self.socket.expect('health')
        self.socket.send(type='record', on=False)
        url = self.socket.expect('recording', lambda message: not message['on'])['url']
        with tempfile.NamedTemporaryFile(suffix='.mkv') as file:
            file.write(self.load(url))
            file.flush()
            pipeline = Gst.parse_launch(f'filesrc location={file.name} ! matroskademux name=d  d.video_0 ! queue ! vp8dec ! fakesink '
                                        'd.video_1 ! queue ! vp8dec ! videoconvert ! depthuncolorize near=5 far=0.5 ! appsink name=depth sync=false')
            pipeline.set_state(Gst.State.PLAYING)
            sample = pipeline.get_by_name('depth').emit('try-pull-sample', 30 * Gst.SECOND)
            pipeline.set_state(Gst.State.NULL)
        self.assertIsNotNone(sample)
        codes = np.frombuffer(sample.get_buffer().extract_dup(0, 160 * 120 * 2), '<u2')
        self.assertGreater((codes > 0).mean(), 0.8)


class Reads(unittest.TestCase):
    def test_rate_of_slow_sweeps_and_of_those_that_stop(self):
        self.assertEqual(rate_of([], 10), 0)
        self.assertEqual(rate_of([9], 10), 0)
        self.assertAlmostEqual(rate_of([8.0, 8.5, 9.0, 9.5, 10.0], 10.1), 2)
        self.assertAlmostEqual(rate_of([0, 4, 8, 12], 13), 0.25)
        self.assertLess(rate_of([0, 4, 8, 12], 30), 0.1)

    def test_peak_of_a_fine_sweep_is_the_middle_of_the_sharp_planes(self):
        self.assertAlmostEqual(peak_of(np.array([0.1, 0.5, 1, 1, 0.999, 1, 1, 0.5, 0.1])), 4)
        self.assertAlmostEqual(peak_of(np.exp(-(np.arange(6) - 2.3) ** 2)), 2.3)
        self.assertEqual(peak_of(np.array([1, 0.5, 0.2])), 0)


    def test_large_things_are_kept_in_smaller_numbers(self):
        kept, dropped = Kept(3, weigh=len, bound=10), []
        kept.dropped = dropped.append
        for text in ('a', 'b', 'c', 'd', 'eight...', 'eleven.....'):
            number = kept.add(text)
        self.assertEqual((kept.get(number), dropped), ('eleven.....', ['a', 'b', 'c', 'd', 'eight...']))


class Refuses(unittest.TestCase):
    def test_foreign_pages_and_names(self):
        with Studio('--launch', PATTERNS) as studio:
            host = f'localhost:{studio.port}'
            self.assertEqual(studio.get('/')[0], 200)
            self.assertEqual(studio.get('/', {'Host': f'127.0.0.1:{studio.port}'})[0], 200)
            self.assertEqual(studio.get('/', {'Host': 'evil.example'})[0], 421)
            self.assertEqual(studio.get('/', {'Host': f'192.0.2.1:{studio.port}'})[0], 421)
            self.assertEqual(studio.get('/live', {**UPGRADE, 'Origin': 'http://evil.example'})[0], 403)
            self.assertEqual(studio.get('/live', {**UPGRADE, 'Origin': 'null'})[0], 403)
            self.assertEqual(studio.get('/live', {**UPGRADE, 'Origin': f'http://{host}', 'Host': 'evil.example'})[0], 421)
            self.assertEqual(studio.get('/live', {**UPGRADE, 'Origin': f'http://{host}'})[0], 101)
            self.assertEqual(studio.get('/overlay/motion.jpg', {'Sec-Fetch-Site': 'cross-site', 'Sec-Fetch-Mode': 'no-cors'})[0], 403)
            for path in ('/../dff-studio', '/main.py', '/frozen/1/depth.bin', '/recording/1.mkv', '/..%2f..%2fmeson.build'):
                self.assertIn(studio.get(path)[0], (400, 404), path)

    def test_only_accounts_come_in_from_elsewhere(self):
        with tempfile.TemporaryDirectory() as folder:
            accounts, certificate = pathlib.Path(folder, 'accounts'), pathlib.Path(folder, 'server.pem')
            accounts.write_text('[accounts]\nanna=her password\n')
            subprocess.run(['openssl', 'req', '-x509', '-newkey', 'ec', '-pkeyopt', 'ec_paramgen_curve:prime256v1', '-nodes', '-days', '2',
                            '-subj', '/CN=localhost', '-keyout', f'{folder}/key', '-out', f'{folder}/cert'], check=True, capture_output=True)
            certificate.write_text(pathlib.Path(folder, 'key').read_text() + pathlib.Path(folder, 'cert').read_text())
            with Studio('--launch', PATTERNS, '--address', '127.0.0.1', '--accounts', accounts, '--certificate', certificate) as studio:
                self.assertTrue(studio.url.startswith('https://'))

                def status(path='/', credentials=None, **headers):
                    if credentials:
                        headers['Authorization'] = 'Basic ' + base64.b64encode(credentials.encode()).decode()
                    return studio.get(path, headers, trusting())[0]
                self.assertEqual(status(), 401)
                self.assertEqual(status(credentials='anna:his password'), 401)
                self.assertEqual(status(credentials='otto:her password'), 401)
                self.assertEqual(status(credentials='anna:'), 401)
                self.assertEqual(status('/live', **UPGRADE), 401)
                self.assertEqual(status('/live', Cookie='dff-studio=guess', **UPGRADE), 401)
                self.assertEqual(status(credentials='anna:her password'), 200)
                self.assertEqual(status('/live', 'anna:her password', **UPGRADE), 101)
                with self.assertRaises(OSError):
                    socket.create_connection(('127.0.0.2', studio.port), 2)

    def test_address_takes_accounts_and_certificate(self):
        for arguments in (['--address', '0.0.0.0'], ['--launch', 'fakesrc ! fakesink'], ['--launch', 'nonsense ! fakesink']):
            with self.assertRaises(AssertionError):
                Studio(*arguments)

    def test_idle_connections_and_browsers_that_go(self):
        with Studio('--launch', PATTERNS) as studio:
            idle = [socket.create_connection(('127.0.0.1', studio.port)) for _ in range(100)]
            self.assertEqual(studio.get('/')[0], 200)
            for connection in idle:
                connection.close()
            Socket(studio).close()
            before = None
            for _ in range(8):
                sockets = [Socket(studio) for _ in range(2)]
                for one in sockets:
                    one.send(type='watch')
                for one in sockets:
                    one.expect('offer')
                    one.close()
                last = Socket(studio)
                last.expect('health')
                last.close()
                before = before or studio.descriptors()
            self.assertLess(studio.descriptors(), before + 12)

    def test_takes_what_the_server_takes(self):
        """captures.txt: what dff-rtsp-server takes and refuses likewise."""
        lines = [line.split('|') for line in (ROOT / 'tests/rtsp/captures.txt').read_text().splitlines() if not line.startswith('#')]
        for outputs, launch in lines:
            if outputs := set(outputs.split()) - {'motion'}:
                source = Source(launch, None, None)
                self.assertEqual(source.sinks.keys() - {'confidence', 'motion'}, outputs, launch)
            else:
                self.assertRaises(Unusable, Source, launch, None, None)
        self.assertGreater(len(lines), 15)

    def test_depth_that_is_none_is_told_by_name(self):
        with Studio('--launch', PATTERNS.replace('GRAY16_LE', 'GRAY8')) as studio:
            text = Socket(studio).expect('state', lambda message: message['bad'])['text']
        for word in ('depth', 'GRAY16_LE', 'GRAY8'):
            self.assertIn(word, text)

    def test_page_is_told_that_the_source_starts_or_is_silent(self):
        silent = 'videotestsrc is-live=true ! video/x-raw,format=GRAY16_LE ! identity drop-probability=1 name=depth'
        with Studio('--launch', AIF.format('num-buffers=5') + silent) as studio:
            page = Socket(studio)
            self.assertIn('starts', page.expect('hello')['state'])
            page.expect('state', lambda message: not message['text'])
            page.expect('health', lambda message: message['rate'] > 0)
            self.assertIn('No frame for', page.expect('state')['text'])

    def test_picture_alone_or_planes_alone_are_shown(self):
        for launch, outputs in ((AIF.format(''), ['aif']), (AIF.format('').replace('aif', 'planes'), ['planes'])):
            with Studio('--launch', launch) as studio:
                page = Socket(studio)
                self.assertEqual(page.expect('hello')['outputs'], outputs)
                page.send(type='watch')
                page.expect('offer')
                frozen = page.ask('frozen', type='freeze', file='picture.png')
                self.assertEqual((frozen['picture'], frozen['facts'], frozen['file']), (True, None, 'picture.png'))
                self.assertEqual(studio.get(f'/frozen/{frozen["number"]}/picture.png')[1][:4], b'\x89PNG')
                self.assertIn('no depth', studio.get(f'/frozen/{frozen["number"]}/cloud.ply')[1].decode())

    def test_page_is_served_where_there_is_nothing_to_show(self):
        with Studio('--launch', PATTERNS.partition('name=aif')[2].replace('name=depth', 'name=uncertainty')) as studio:
            page = Socket(studio)
            self.assertEqual(page.expect('hello')['tracks'], [])
            page.send(type='watch')
            page.expect('state', lambda message: not message['text'])
            page.send(type='freeze')
            self.assertIn('no frame', page.expect('problem')['text'])

    def test_uncertainty_comes_with_the_value(self):
        with Studio('--launch', rig().replace('name=maker', 'name=maker maker.uncertainty ! queue ! identity name=uncertainty  maker.')) as studio:
            page = Socket(studio)
            self.assertIn('uncertainty', page.expect('hello')['outputs'])
            page.expect('health', lambda message: message['rate'] > 0)
            frozen = page.ask('frozen', type='freeze')['number']
            found = [page.ask('probe', type='probe', x=x / 8, y=0.5, frozen=frozen).get('deviation') for x in range(1, 8)]
            self.assertTrue(any(deviation and 0 < deviation < 1 for deviation in found), found)

    def test_source_that_ends_is_started_again(self):
        with Studio('--launch', PATTERNS.replace('is-live=true', 'is-live=true num-buffers=5')) as studio:
            page = Socket(studio)
            for _ in range(2):
                self.assertIn('end', page.expect('state', lambda message: message['text'])['text'])
                page.expect('state', lambda message: not message['text'])


if __name__ == '__main__':
    unittest.main(argv=['test_server.py', *__import__('sys').argv[1:]])
