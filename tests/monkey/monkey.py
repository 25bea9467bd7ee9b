#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A monkey at the window: types, clicks, drags and drops at random, as fast as X takes it, until the time is over. Needs python3-xlib and a
display of its own; its seed repeats what it does (not when the window sees it).

    xvfb-run -a -s "-screen 0 1000x700x24" tests/monkey/monkey.py --seed 1 --seconds 1800 --folder DIR build/release/catena scene.json ...

Works in DIR, which should be an empty folder of scenes and data: it saves, overwrites and discards. Every start takes one of the scenes.
Now and then the window is closed by the keyboard, or killed, and opened again.
Exit code 0: the window never ended by itself and always answered. 1: it did not; what was done last stands on stdout, all in DIR/monkey.log.
"""
import argparse
import pathlib
import random
import subprocess
import sys
import time

from Xlib import X, XK, display
from Xlib.ext import xtest
from Xlib.protocol import event

PATIENCE_S = 90
WORDS = ["a.json", "Capital.json", "new scene.json", "../x", "none.vdb", "/", "grid.vdb", "0.5", "-1e30", "nan", "1e999", "0,0", "[", "H q Q"]
COMMANDS = ["ctrl+o", "ctrl+s", "ctrl+shift+s", "ctrl+z", "ctrl+z", "ctrl+y", "ctrl+a", "ctrl+c", "ctrl+v", "ctrl+x", "Tab", "F1", "F2", "F11",
            "F12", "shift+F12", "Home", "Return", "Return", "Escape", "Escape", "BackSpace", "Delete", "Left", "Right", "Up", "Down", "shift+Left",
            "ctrl+shift+Left", "Page_Up", "Page_Down", "Q", "q", "h", "f", "t", "v", "p", "o", "r", "space", "1", "shift+2", "question", "4", "4", "ctrl+shift+o"]
MODIFIERS = {"ctrl": XK.XK_Control_L, "shift": XK.XK_Shift_L, "alt": XK.XK_Alt_L}


class Window:
    """The program and its window on the display."""

    def __init__(self, server, command, folder, log):
        self.server, self.root, self.log = server, server.screen().root, log
        self.root.change_attributes(event_mask=X.SubstructureNotifyMask)
        self.process = subprocess.Popen(command, cwd=folder, stdout=log, stderr=log)
        self.window = None
        end = time.time() + PATIENCE_S
        while self.window is None and self.process.poll() is None and time.time() < end:
            time.sleep(0.05)
            self.window = self.find()
        if self.window is not None:
            self.window.set_input_focus(X.RevertToPointerRoot, X.CurrentTime)
            self.server.sync()

    def find(self):
        wanted = self.server.intern_atom("_NET_WM_PID")
        for child in self.root.query_tree().children:
            try:
                pid = child.get_full_property(wanted, X.AnyPropertyType)
                if pid is not None and pid.value[0] == self.process.pid and child.get_attributes().map_state == X.IsViewable:
                    return child
            except Exception:  # it has gone meanwhile
                continue
        return None

    def answers(self):
        """Whether it answers a ping within PATIENCE_S; None: it has ended."""
        atom = self.server.intern_atom
        stamp = random.SystemRandom().randrange(1, 1 << 30)
        try:
            self.window.send_event(event.ClientMessage(window=self.window, client_type=atom("WM_PROTOCOLS"),
                                                       data=(32, [atom("_NET_WM_PING"), stamp, self.window.id, 0, 0])))
            self.server.flush()
        except Exception:
            pass
        end = time.time() + PATIENCE_S
        while time.time() < end:
            if self.process.poll() is not None:
                return None
            while self.server.pending_events() > 0:
                news = self.server.next_event()
                if news.type == X.ClientMessage and news.data[0] == 32 and news.data[1][1] == stamp:
                    return True
            time.sleep(0.01)
        return False


class Monkey:
    def __init__(self, server, seed, drop, folder):
        self.server, self.random, self.drop, self.folder = server, random.Random(seed), drop, folder
        self.held, self.buttons = [], []
        screen = server.screen()
        self.width, self.height = screen.width_in_pixels, screen.height_in_pixels

    # ---- hands ----
    def key(self, keysym, down):
        code = self.server.keysym_to_keycode(keysym)
        if code:
            xtest.fake_input(self.server, X.KeyPress if down else X.KeyRelease, code)

    def stroke(self, name):
        """"ctrl+shift+Left"; a capital is typed with shift."""
        *modifiers, last = name.split("+") if name != "+" else ["plus"]
        keysym = XK.string_to_keysym(last) or ord(last)
        if len(last) == 1 and (last.isupper() or self.server.keycode_to_keysym(self.server.keysym_to_keycode(keysym), 0) != keysym):
            modifiers = [*modifiers, "shift"]
        overlap = self.random.random() < 0.3  # fast hands: the key comes up after its modifiers, or the other way round
        for modifier in modifiers:
            self.key(MODIFIERS[modifier], True)
        self.key(keysym, True)
        if not overlap:
            self.key(keysym, False)
        for modifier in reversed(modifiers):
            self.key(MODIFIERS[modifier], False)
        if overlap:
            self.key(keysym, False)

    def move(self, x, y):
        xtest.fake_input(self.server, X.MotionNotify, x=x, y=y)

    def button(self, which, down):
        xtest.fake_input(self.server, X.ButtonPress if down else X.ButtonRelease, which)

    def place(self):
        """Half of them in the side panel."""
        on_panel = self.random.random() < 0.5
        return self.random.randrange(0, 330 if on_panel else self.width), self.random.randrange(0, self.height)

    def let_go(self):
        for keysym in self.held:
            self.key(keysym, False)
        for which in self.buttons:
            self.button(which, False)
        self.held, self.buttons = [], []

    # ---- what it does; each returns what it was, in words ----
    def command(self):
        name = self.random.choice(COMMANDS)
        self.stroke(name)
        return name

    def types(self):
        text = self.random.choice(WORDS) if self.random.random() < 0.4 else "".join(
            chr(self.random.randrange(32, 127)) for _ in range(self.random.randrange(1, 12)))
        for letter in text:
            self.stroke({" ": "space", "+": "plus"}.get(letter, letter))
        return "types " + repr(text)

    def open_by_name(self):
        name = self.random.choice(WORDS)
        self.stroke("ctrl+o")
        for letter in name:
            self.stroke({" ": "space"}.get(letter, letter))
        self.stroke("Return")
        return "opens " + repr(name)

    def click(self):
        x, y = self.place()
        which, times = self.random.choice([1, 1, 1, 2, 3]), self.random.choice([1, 1, 1, 2, 3])
        self.move(x, y)
        for _ in range(times):
            self.button(which, True)
            self.button(which, False)
        return f"clicks {which} {times} times at {x} {y}"

    def drag(self):
        x, y = self.place()
        which = self.random.choice([1, 1, 1, 2, 3])
        self.move(x, y)
        self.button(which, True)
        steps = self.random.randrange(1, 10)
        for _ in range(steps):
            x = min(max(x + self.random.randrange(-60, 61), 0), self.width - 1)
            y = min(max(y + self.random.randrange(-60, 61), 0), self.height - 1)
            self.move(x, y)
            if self.random.random() < 0.1:
                self.command()
        self.button(which, False)
        return f"drags {which} to {x} {y}"

    def wheel(self):
        x, y = self.place()
        self.move(x, y)
        which, times = self.random.choice([4, 5]), self.random.randrange(1, 30)
        for _ in range(times):
            self.button(which, True)
            self.button(which, False)
        return f"turns the wheel {which} {times} times at {x} {y}"

    def holds(self):
        """A key or a button that stays down for a while."""
        if self.random.random() < 0.5:
            keysym = self.random.choice([*MODIFIERS.values(), ord("w"), ord("a"), XK.XK_space, XK.XK_Left])
            self.key(keysym, True)
            self.held.append(keysym)
            return f"holds {keysym}"
        which = self.random.choice([1, 2, 3])
        self.button(which, True)
        self.buttons.append(which)
        return f"holds button {which}"

    def lets_go(self):
        self.let_go()
        return "lets go"

    def waits(self):
        self.server.flush()
        time.sleep(self.random.choice([0.02, 0.2, 1]))
        return "waits"

    def resizes(self, window):
        if self.random.random() < 0.3:
            width, height = self.random.choice([(1, 1), (40, 900), (1000, 30), (2000, 1500)])
        else:
            width, height = self.random.randrange(200, 1000), self.random.randrange(150, 700)
        window.window.configure(width=width, height=height, x=0, y=0)
        return f"resizes to {width} {height}"

    def looks_away(self, window):
        self.server.screen().root.set_input_focus(X.RevertToPointerRoot, X.CurrentTime)
        self.types()
        window.window.set_input_focus(X.RevertToPointerRoot, X.CurrentTime)
        return "looks away and back"

    def drops(self, window):
        files = sorted(p.name for p in pathlib.Path(self.folder).iterdir() if p.suffix in (".json", ".vdb", ".png", ".csv"))
        if not files:
            return "has nothing to drop"
        name = self.random.choice(files)
        self.server.sync()
        subprocess.run([sys.executable, self.drop, str(window.window.id), str(pathlib.Path(self.folder) / name)], timeout=PATIENCE_S, check=False)
        return "drops " + name

    def act(self, window):
        weights = {self.command: 30, self.types: 14, self.click: 30, self.drag: 14, self.wheel: 5, self.open_by_name: 1, self.holds: 3,
                   self.lets_go: 4, self.waits: 4}
        acts = {self.resizes: 1, self.looks_away: 1, self.drops: 0.3}
        chosen = self.random.choices([*weights, *acts], [*weights.values(), *acts.values()])[0]
        said = chosen(window) if chosen in acts else chosen()
        self.server.flush()
        return said


def play(options, server, log):
    monkey = Monkey(server, options.seed, str(pathlib.Path(__file__).resolve().parent.parent / "support/drop_file.py"), options.folder)
    scenes = options.view
    end = time.time() + options.seconds
    window, done, actions, starts = None, [], 0, 0
    while time.time() < end:
        if window is None:
            scene = monkey.random.choice(scenes)
            arguments = [scene] if pathlib.Path(options.folder, scene).exists() else []
            window = Window(server, [options.program, "view", *arguments, "--size", "900x600"], options.folder, log)
            starts += 1
            done.append("starts " + scene)
            if window.window is None:
                # a scene that the monkey itself has spoilt is refused in one line; an abort is not
                if window.process.poll() == 2:
                    window, scenes = None, [s for s in scenes if s != scene] or [""]
                    continue
                return f"no window: exit code {window.process.poll()}", done, actions, starts
        try:
            done.append(monkey.act(window))
        except Exception as problem:  # the window has gone: seen below
            done.append(f"({problem})")
        actions += 1
        print(done[-1], file=log, flush=True)
        if actions % 25 == 0 or window.process.poll() is not None:
            answered = window.answers()
            if answered is False:
                return "the window does not answer", done, actions, starts
            if answered is None:
                code = window.process.returncode
                if code != 0:
                    return f"the window ended: exit code {code}", done, actions, starts
                monkey.let_go()
                window = None
                continue
            if monkey.random.random() < 0.02:  # a crash: what was unsaved is offered
                window.process.kill()
                window.process.wait()
                done.append("kills the window")
                monkey.let_go()
                window = None
            elif monkey.random.random() < 0.05:
                monkey.let_go()
                for name in ["Escape", "ctrl+q", *monkey.random.choice([["Escape"], ["Return"], []])]:
                    monkey.stroke(name)
                done.append("quits")
    if window is not None:
        window.process.kill()
        window.process.wait()
    return None, done, actions, starts


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=1800)
    parser.add_argument("--folder", required=True)
    parser.add_argument("program")
    parser.add_argument("view", nargs="+", help="scenes of the folder")
    options = parser.parse_args()
    options.program = str(pathlib.Path(options.program).resolve())
    with open(pathlib.Path(options.folder) / "monkey.log", "w", encoding="utf-8") as log:
        problem, done, actions, starts = play(options, display.Display(), log)
    print(f"seed {options.seed}: {actions} actions, {starts} starts" + (f": {problem}" if problem else ": fine"))
    if problem:
        print("\n".join("  " + act for act in done[-40:]))
    return 1 if problem else 0


if __name__ == "__main__":
    sys.exit(main())
