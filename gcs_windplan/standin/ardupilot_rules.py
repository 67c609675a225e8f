"""ArduPilot's mission server.

As measured on ArduCopter 4.7 and as in MissionItemProtocol.cpp: it asks with MISSION_REQUEST, asks again after a
second, gives up after eight. A mission is written over the old one item by item, so that what broke half-way is
half of each; a fence is gathered first. Item 0 is home, whatever is sent. A cancel is not understood: an upload
ends when its sender falls silent.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.link.codec import Message
from gcs_windplan.link.peer import Ident
from gcs_windplan.link.peer import sender as sender_of
from gcs_windplan.mission.firmware import Firmware
from gcs_windplan.standin.items import FENCE, MISSION, RALLY, Refusal, StoredItem, item_message, read_item
from gcs_windplan.standin.rules import Pilot, ServerOptions, Storekeeper, acknowledge, result_name, text, type_name
from gcs_windplan.standin.storage import fence_fault, store

_FLY_THERE, _CHANGE_ALTITUDE = 2, 3  # an item's `current`
_DONE_TEXTS = {MISSION: "SimulatedFlight plan received", RALLY: "Rally points received"}
_LATE_TEXTS = {MISSION: "Mission upload timeout", FENCE: "Fence upload timeout", RALLY: "Rally upload timeout"}


@dataclass(slots=True)
class _Upload:
    """One that is on its way: item `seq` was asked for, `last` is the last one."""

    sender: Ident
    seq: int
    last: int
    began: float
    heard: float
    asked: float
    gathered: list[StoredItem]


class ArduPilotMissions(Storekeeper):
    """See `MissionServer`. Mission, fence and rally points are separate here: one can arrive while another does."""

    def __init__(self, firmware: Firmware, pilot: Pilot, options: ServerOptions, now: float) -> None:
        super().__init__(firmware, pilot, options)
        self._booted = now
        self._uploads: dict[int, _Upload] = {}
        self._answers: dict[str, Callable[[Message, Ident, float], list[Message]]] = {
            "MISSION_COUNT": self._count,
            "MISSION_ITEM": self._item,
            "MISSION_ITEM_INT": self._item,
            "MISSION_REQUEST_LIST": self._list,
            "MISSION_REQUEST": self._request,
            "MISSION_REQUEST_INT": self._request,
            "MISSION_CLEAR_ALL": self._clear,
            "MISSION_WRITE_PARTIAL_LIST": self._write_partial,
        }

    @property
    def items(self) -> Mapping[int, list[StoredItem]]:
        """What the vehicle holds; item 0 of the mission is home."""
        mission = self._held[MISSION]
        return {**self._held, MISSION: [self._pilot.home_item, *mission[1:]] if mission else []}

    @property
    def wake(self) -> float:
        """When an item is to be asked for again, or an upload given up."""
        times = (
            min(upload.asked + self._firmware.transfers.ask_again, upload.heard + self._firmware.transfers.give_up)
            for upload in self._uploads.values()
        )
        return min(times, default=math.inf)

    @property
    def sent_home(self) -> StoredItem | None:
        """What was sent as item 0."""
        return next(iter(self._held[MISSION]), None)

    def reboot(self, now: float) -> None:
        """Start again."""
        self._booted = now
        self._uploads.clear()

    def handle(self, message: Message, now: float) -> list[Message]:
        """Answer a mission message."""
        kind = message.get_type()
        if not _is_for(self._options, message):
            return []
        if kind == "MISSION_SET_CURRENT":
            return self._set_current(message.seq)
        answer = self._answers.get(kind)
        if answer is None:
            return []
        sender, mission_type = sender_of(message), message.mission_type
        if mission_type not in self._held:
            return [self._no(sender, mavlink.MAV_MISSION_UNSUPPORTED, mission_type, "there is no such type")]
        if self._options.mavlink1 and mission_type != MISSION:
            refusal = self._no(sender, mavlink.MAV_MISSION_UNSUPPORTED, mission_type, "MAVLink 1 has none")
            return [text(mavlink.MAV_SEVERITY_WARNING, "Need mavlink2 for item transfer"), refusal]
        return answer(message, sender, now)

    def tick(self, now: float) -> list[Message]:
        """Ask again, or give up."""
        said: list[Message] = []
        for mission_type, upload in list(self._uploads.items()):
            if now - upload.heard >= self._firmware.transfers.give_up:
                said += self._give_up(mission_type, upload)
            elif now - upload.asked >= self._firmware.transfers.ask_again:
                self.notes.append(f"asked {upload.sender} again for item {upload.seq} of its {type_name(mission_type)}")
                said.append(self._ask(mission_type, upload, now))
        return said

    def _count(self, message: Message, sender: Ident, now: float) -> list[Message]:
        mission_type, count = message.mission_type, message.count
        running = self._uploads.get(mission_type)
        if running is not None and running.sender != sender:
            why = f"{running.sender} is uploading"
            return [self._no(sender, mavlink.MAV_MISSION_DENIED, mission_type, why)]
        if now - self._booted < self._firmware.transfers.booting or count > self._capacity[mission_type]:
            return self._no_space(sender, mission_type, count, now)
        self._uploads.pop(mission_type, None)
        if mission_type != FENCE:
            del self._held[mission_type][count:]  # not atomic: the old mission is cut first
        upload = _Upload(sender, 0, count - 1, now, now, now, [])
        if count == 0:
            return self._complete(mission_type, upload, now)
        again = "begins again" if running is not None else "begins"
        self.notes.append(f"upload of {count} items of {type_name(mission_type)} by {sender} {again}")
        self._uploads[mission_type] = upload
        return [self._ask(mission_type, upload, now)]

    def _no_space(self, sender: Ident, mission_type: int, count: int, now: float) -> list[Message]:
        if now - self._booted < self._firmware.transfers.booting:
            return [self._no(sender, mavlink.MAV_MISSION_NO_SPACE, mission_type, "still booting")]
        most = self._capacity[mission_type]
        refusal = self._no(sender, mavlink.MAV_MISSION_NO_SPACE, mission_type, f"{count} items, room for {most}")
        return [refusal, text(mavlink.MAV_SEVERITY_WARNING, f"Only {most} items are supported")]

    def _item(self, message: Message, sender: Ident, now: float) -> list[Message]:
        item, mission_type = read_item(message), message.mission_type
        if item.current in (_FLY_THERE, _CHANGE_ALTITUDE):
            code = mavlink.MAV_MISSION_ACCEPTED if self._pilot.fly_there(item) else mavlink.MAV_MISSION_ERROR
            self.notes.append(f"{sender} sent an item with current = {item.current}: {result_name(code)}")
            return [acknowledge(sender, code, mission_type)]
        upload = self._uploads.get(mission_type)
        if upload is None:
            return [self._no(sender, mavlink.MAV_MISSION_ERROR, mission_type, f"item {message.seq} without an upload")]
        if message.seq != upload.seq:
            why = f"item {message.seq} in place of {upload.seq}"
            return [self._no(sender, mavlink.MAV_MISSION_INVALID_SEQUENCE, mission_type, why)]
        if sender != upload.sender:
            why = f"{upload.sender} is uploading"
            return [self._no(sender, mavlink.MAV_MISSION_DENIED, mission_type, why)]
        refusal = self._store(mission_type, upload, item)
        if refusal is not None:
            del self._uploads[mission_type]
            return [self._no(sender, refusal.code, mission_type, f"item {upload.seq}: {refusal.reason}")]
        return self._next(mission_type, upload, now)

    def _next(self, mission_type: int, upload: _Upload, now: float) -> list[Message]:
        upload.heard = now
        upload.seq += 1
        if upload.seq > upload.last:
            return self._complete(mission_type, upload, now)
        return [self._ask(mission_type, upload, now)]

    def _store(self, mission_type: int, upload: _Upload, item: StoredItem) -> Refusal | None:
        """Write the item where it belongs, over the old one if there is one; a refusal leaves the old one."""
        kept = store(item, mission_type, self._firmware)
        if isinstance(kept, Refusal):
            return kept
        held = upload.gathered if mission_type == FENCE else self._held[mission_type]
        if mission_type == MISSION and item.command == mavlink.MAV_CMD_DO_JUMP:
            target = kept.params[0]
            if target == 0 or (target >= len(held) and target > upload.last):
                return Refusal(mavlink.MAV_MISSION_ERROR, f"the jump leads to item {target:.0f}, and there is none")
        if upload.seq < len(held):
            held[upload.seq] = kept
        elif upload.seq == len(held):
            held.append(kept)
        else:
            return Refusal(mavlink.MAV_MISSION_ERROR, f"it lies behind the end, which is item {len(held)}")
        return None

    def _complete(self, mission_type: int, upload: _Upload, now: float) -> list[Message]:
        self._uploads.pop(mission_type, None)
        if mission_type == FENCE:
            fault = fence_fault(upload.gathered)
            if fault is not None:
                return [self._no(upload.sender, mavlink.MAV_MISSION_ERROR, mission_type, fault)]
            self._held[FENCE] = upload.gathered
        self.arrived.add(mission_type)
        name, count, took = type_name(mission_type), len(self._held[mission_type]), now - upload.began
        self.notes.append(f"upload of {name} by {upload.sender} accepted: {count} items in {took:.2f} s")
        said = [acknowledge(upload.sender, mavlink.MAV_MISSION_ACCEPTED, mission_type)]
        if mission_type in _DONE_TEXTS:
            said.insert(0, text(mavlink.MAV_SEVERITY_INFO, _DONE_TEXTS[mission_type]))
        return said

    def _give_up(self, mission_type: int, upload: _Upload) -> list[Message]:
        del self._uploads[mission_type]
        why = f"item {upload.seq} did not come in {self._firmware.transfers.give_up:.0f} s"
        return [
            text(mavlink.MAV_SEVERITY_WARNING, _LATE_TEXTS[mission_type]),
            self._no(upload.sender, mavlink.MAV_MISSION_OPERATION_CANCELLED, mission_type, why),
        ]

    def _list(self, message: Message, sender: Ident, now: float) -> list[Message]:
        mission_type = message.mission_type
        if mission_type in self._uploads:
            return [self._no(sender, mavlink.MAV_MISSION_DENIED, mission_type, "an upload is on its way")]
        count = len(self._held[mission_type])
        self.notes.append(f"download of {type_name(mission_type)} by {sender}: {count} items")
        return [mavlink.MAVLink_mission_count_message(sender.system, sender.component, count, mission_type)]

    def _request(self, message: Message, sender: Ident, now: float) -> list[Message]:
        mission_type, seq = message.mission_type, message.seq
        if mission_type in self._uploads:
            return [self._no(sender, mavlink.MAV_MISSION_DENIED, mission_type, "an upload is on its way")]
        held, is_home = self._held[mission_type], mission_type == MISSION and seq == 0
        if seq >= len(held) and not is_home:  # home can always be read
            return self._no_such_item(sender, mission_type, seq, len(held))
        as_int = message.get_type() == "MISSION_REQUEST_INT"
        current = mission_type == MISSION and seq == self._pilot.current
        item = self._pilot.home_item if is_home else held[seq]
        return [item_message(item, seq, sender, mission_type, current, as_int)]

    def _no_such_item(self, sender: Ident, mission_type: int, seq: int, count: int) -> list[Message]:
        why = f"item {seq} of {count} was asked for"
        if mission_type != MISSION:
            return [self._no(sender, mavlink.MAV_MISSION_INVALID_SEQUENCE, mission_type, why)]
        told = mavlink.MAVLink_mission_count_message(sender.system, sender.component, count, mission_type)
        return [told, self._no(sender, mavlink.MAV_MISSION_ERROR, mission_type, why)]

    def _clear(self, message: Message, sender: Ident, now: float) -> list[Message]:
        mission_type = message.mission_type
        if mission_type in self._uploads:
            return [self._no(sender, mavlink.MAV_MISSION_ERROR, mission_type, "an upload is on its way")]
        if mission_type == MISSION and self._pilot.flies_mission:
            return [self._no(sender, mavlink.MAV_MISSION_ERROR, mission_type, "the mission is being flown")]
        self._held[mission_type] = []
        self.notes.append(f"{type_name(mission_type)} cleared by {sender}")
        return [acknowledge(sender, mavlink.MAV_MISSION_ACCEPTED, mission_type)]

    def _write_partial(self, message: Message, sender: Ident, now: float) -> list[Message]:
        mission_type, first, last = message.mission_type, message.start_index, message.end_index
        held = self._held[mission_type]
        if not 0 <= first <= last <= len(held) or mission_type in self._uploads:
            why = f"items {first} to {last} of {len(held)} cannot be replaced"
            return [self._no(sender, mavlink.MAV_MISSION_ERROR, mission_type, why)]
        upload = _Upload(sender, first, last, now, now, now, list(held))
        self.notes.append(f"upload of items {first} to {last} of {type_name(mission_type)} by {sender} begins")
        self._uploads[mission_type] = upload
        return [self._ask(mission_type, upload, now)]

    def _set_current(self, seq: int) -> list[Message]:
        if seq >= len(self._held[MISSION]) or not self._pilot.jump(seq):
            self.notes.append(f"item {seq} cannot be made the current one")
            return [text(mavlink.MAV_SEVERITY_WARNING, f"Mission item {seq} does not exist")]
        self.notes.append(f"item {seq} is the current one")
        return [mavlink.MAVLink_mission_current_message(self._pilot.current)]

    def _ask(self, mission_type: int, upload: _Upload, now: float) -> Message:
        upload.asked = now
        to = upload.sender
        return mavlink.MAVLink_mission_request_message(to.system, to.component, upload.seq, mission_type)

    def _no(self, to: Ident, code: int, mission_type: int, why: str) -> Message:
        self.notes.append(f"refused {to} ({type_name(mission_type)}): {result_name(code)}, {why}")
        return acknowledge(to, code, mission_type)


def _is_for(options: ServerOptions, message: Message) -> bool:
    """Whether the message is meant for this vehicle; system and component 0 mean everybody."""
    return message.target_system in (0, options.system) and message.target_component in (0, options.component)
