#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Drops a file onto a window as a file manager does (XDND, version 5). Needs python3-xlib.

    drop_file.py WINDOW_ID FILE      exit code 0: the window has taken it; 1: it did not answer or refused
"""
import pathlib
import sys
import time

from Xlib import X, Xatom, display
from Xlib.protocol import event

PATIENCE_S = 30


def main():
    target_id, path = int(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
    server = display.Display()
    root = server.screen().root
    target = server.create_resource_object("window", target_id)
    source = root.create_window(0, 0, 1, 1, 0, X.CopyFromParent)
    atom = server.intern_atom
    uri_list = atom("text/uri-list")
    source.set_selection_owner(atom("XdndSelection"), X.CurrentTime)

    def tell(kind, data):
        target.send_event(event.ClientMessage(window=target, client_type=atom(kind), data=(32, data)), event_mask=X.NoEventMask)
        server.flush()

    place = target.get_geometry()
    corner = root.translate_coords(target, 0, 0)
    x, y = -corner.x + place.width * 2 // 3, -corner.y + place.height // 2
    tell("XdndEnter", [source.id, 5 << 24, uri_list, 0, 0])
    tell("XdndPosition", [source.id, 0, (x << 16) | y, X.CurrentTime, atom("XdndActionCopy")])
    end = time.time() + PATIENCE_S
    while time.time() < end:
        if server.pending_events() == 0:
            time.sleep(0.01)
            continue
        news = server.next_event()
        if news.type == X.SelectionRequest:
            news.requestor.change_property(news.property, news.target, 8, (path.as_uri() + "\r\n").encode())
            news.requestor.send_event(event.SelectionNotify(time=news.time, requestor=news.requestor, selection=news.selection,
                                                            target=news.target, property=news.property))
            server.flush()
        elif news.type == X.ClientMessage and news.client_type == atom("XdndStatus"):
            if not news.data[1][1] & 1:
                return 1
            tell("XdndDrop", [source.id, 0, X.CurrentTime, 0, 0])
        elif news.type == X.ClientMessage and news.client_type == atom("XdndFinished"):
            return 0
    return 1


if __name__ == "__main__":
    sys.exit(main())
