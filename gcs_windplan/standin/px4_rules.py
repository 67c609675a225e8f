"""PX4's mission server, as in mavlink_mission.cpp.

One transfer at a time. It asks again after 250 ms and gives up after 5 s. What arrives is gathered beside the old
mission and takes its place when it is whole. The last item, sent again after that, is acknowledged again.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Literal

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.link.codec import Message
from gcs_windplan.link.peer import Ident
from gcs_windplan.link.peer import sender as sender_of
from gcs_windplan.mission.firmware import Firmware
from gcs_windplan.standin.items import MISSION, Refusal, StoredItem, item_message, plain, read_item
from gcs_windplan.standin.rules import Pilot, ServerOptions, Storekeeper, acknowledge, result_name, text, type_name
from gcs_windplan.standin.storage import infeasible, store

_ALL_TYPES = 255
_COMPONENTS = (0, mavlink.MAV_COMP_ID_MISSIONPLANNER)  # answered besides its own


class Px4Missions(Storekeeper):
    """See `MissionServer`."""

    def __init__(self, firmware: Firmware, pilot: Pilot, options: ServerOptions, now: float) -> None:
        super().__init__(firmware, pilot, options)
        self._state: Literal["idle", "taking", "giving"] = "idle"
        self._partner = Ident(0, 0)
        self._type = MISSION
        self._gathered: list[StoredItem] = []
        self._seq = 0  # of the item that is expected, or was asked of us last plus one
        self._count = 0
        self._as_int = True
        self._began = self._heard = self._sent = now
        self._answers: dict[str, Callable[[Message, Ident, float], list[Message]]] = {
            "MISSION_COUNT": self._handle_count,
            "MISSION_ITEM": self._handle_item,
            "MISSION_ITEM_INT": self._handle_item,
            "MISSION_REQUEST_LIST": self._handle_list,
            "MISSION_REQUEST": self._handle_request,
            "MISSION_REQUEST_INT": self._handle_request,
            "MISSION_CLEAR_ALL": self._handle_clear,
            "MISSION_ACK": self._handle_ack,
            "MISSION_SET_CURRENT": self._handle_current,
        }

    @property
    def items(self) -> Mapping[int, list[StoredItem]]:
        """What the vehicle holds."""
        return self._held

    @property
    def wake(self) -> float:
        """When an item is to be asked for again, or a transfer given up."""
        if self._state == "taking":
            return min(self._sent + self._firmware.transfers.ask_again, self._heard + self._firmware.transfers.give_up)
        return self._heard + self._firmware.transfers.give_up if self._state == "giving" else math.inf

    @property
    def sent_home(self) -> StoredItem | None:
        """None: PX4 knows no home item."""
        return None

    def reboot(self, now: float) -> None:
        """Start again."""
        self._state, self._partner, self._seq, self._count = "idle", Ident(0, 0), 0, 0

    def handle(self, message: Message, now: float) -> list[Message]:
        """Answer a mission message."""
        answer = self._answers.get(message.get_type())
        own = (self._options.component, *_COMPONENTS)
        if answer is None or message.target_system != self._options.system or message.target_component not in own:
            return []
        return answer(message, sender_of(message), now)

    def tick(self, now: float) -> list[Message]:
        """Ask again, or give up."""
        if self._state != "idle" and now - self._heard >= self._firmware.transfers.give_up:
            what, patience = type_name(self._type), self._firmware.transfers.give_up
            self.notes.append(f"transfer of {what} with {self._partner} given up after {patience:.0f} s")
            self._state = "idle"
            return [self._critical("Operation timeout")]
        if self._state == "taking" and now - self._sent >= self._firmware.transfers.ask_again:
            self.notes.append(f"asked {self._partner} again for item {self._seq} of its {type_name(self._type)}")
            return [self._ask(now)]
        return []

    def _handle_count(self, message: Message, sender: Ident, now: float) -> list[Message]:
        if self._state == "giving" or (self._state == "taking" and sender != self._partner):
            return [self._no(sender, mavlink.MAV_MISSION_ERROR, message.mission_type, f"busy with {self._partner}")]
        self._heard = now
        if self._state == "taking" and self._seq > 0:
            why = f"a COUNT again, while item {self._seq} is awaited"
            return [self._critical("WPM: REJ. CMD: Busy"), self._no(sender, mavlink.MAV_MISSION_ERROR, self._type, why)]
        if self._state == "idle":
            refused = self._begin(message, sender, now)
            if refused is not None:
                return refused
        return [self._ask(now)]

    def _begin(self, message: Message, sender: Ident, now: float) -> list[Message] | None:
        """Begin an upload; or the answer, where there is none to begin."""
        self._partner, self._type = sender, message.mission_type
        if self._type not in self._held:
            return [self._no(sender, mavlink.MAV_MISSION_INVALID, self._type, "there is no such type")]
        if message.count > self._capacity[self._type]:
            why = f"{message.count} items, room for {self._capacity[self._type]}"
            return [self._no(sender, mavlink.MAV_MISSION_NO_SPACE, self._type, why)]
        self._seq, self._count, self._gathered, self._began = 0, message.count, [], now
        if message.count == 0:
            return self._replace(now)
        self.notes.append(f"upload of {message.count} items of {type_name(self._type)} by {sender} begins")
        self._state = "taking"
        return None

    def _handle_item(self, message: Message, sender: Ident, now: float) -> list[Message]:
        self._as_int = message.get_type() == "MISSION_ITEM_INT"
        if sender != self._partner:
            self.notes.append(f"item {message.seq} by {sender} ignored: it began no upload")
            return [self._critical("REJ. MIS ITEM: partner id mismatch")]
        if message.mission_type != self._type:
            why = f"item {message.seq} is of the type {type_name(message.mission_type)}"
            return [self._no(sender, mavlink.MAV_MISSION_ERROR, self._type, why)]
        if self._state != "taking":
            return self._late_item(message.seq)
        self._heard = now
        if message.seq != self._seq:
            self.notes.append(f"item {message.seq} ignored: item {self._seq} is awaited")
            return []
        kept = store(read_item(message), self._type, self._firmware)
        if isinstance(kept, Refusal):
            self._state = "idle"
            refusal = self._no(sender, kept.code, self._type, f"item {message.seq}: {kept.reason}")
            return [self._critical("IGN MISSION_ITEM: Invalid item"), refusal]
        self._gathered.append(kept)
        self._seq += 1
        return self._replace(now) if self._seq == self._count else [self._ask(now)]

    def _late_item(self, seq: int) -> list[Message]:
        """The last item again: our ACK was lost. Any other has no business here."""
        if self._state == "idle" and self._seq == seq + 1:
            self.notes.append(f"the last item by {self._partner} came again: acknowledged again")
            return [acknowledge(self._partner, mavlink.MAV_MISSION_ACCEPTED, self._type)]
        why = f"item {seq} without an upload"
        said = self._critical("IGN MISSION_ITEM: No transfer" if self._state == "idle" else "IGN MISSION_ITEM: Busy")
        return [said, self._no(self._partner, mavlink.MAV_MISSION_ERROR, self._type, why)]

    def _replace(self, now: float) -> list[Message]:
        """Put what was gathered in place of what is held."""
        self._state = "idle"
        self._held[self._type] = self._gathered
        name, count, took = type_name(self._type), len(self._gathered), now - self._began
        self.notes.append(f"upload of {name} by {self._partner} accepted: {count} items in {took:.2f} s")
        self.arrived.add(self._type)
        said = [acknowledge(self._partner, mavlink.MAV_MISSION_ACCEPTED, self._type)]
        fault = infeasible(self._gathered, self._firmware) if self._type == MISSION else None
        if fault is not None:
            self.notes.append(f"the mission is held and will not be flown: {fault}")
            said.append(self._critical(f"Mission rejected: {fault}"))
        return said

    def _handle_list(self, message: Message, sender: Ident, now: float) -> list[Message]:
        if self._seq == len(self._held.get(self._type, ())):
            self._state = "idle"  # everything was sent, and the ACK was lost
        same = self._state == "giving" and sender == self._partner and message.mission_type == self._type
        if self._state != "idle" and not same:
            self.notes.append(f"download by {sender} ignored: busy with {self._partner}")
            words = "Mission download request ignored, already active"
            return [text(mavlink.MAV_SEVERITY_INFO, words)]
        if message.mission_type not in self._held:
            return [self._no(sender, mavlink.MAV_MISSION_UNSUPPORTED, message.mission_type, "there is no such type")]
        self._state, self._partner, self._type = "giving", sender, message.mission_type
        self._seq, self._count, self._heard = 0, len(self._held[self._type]), now
        self.notes.append(f"download of {type_name(self._type)} by {sender}: {self._count} items")
        return [mavlink.MAVLink_mission_count_message(sender.system, sender.component, self._count, self._type)]

    def _handle_request(self, message: Message, sender: Ident, now: float) -> list[Message]:
        self._as_int = message.get_type() == "MISSION_REQUEST_INT"
        if sender != self._partner:
            return [self._critical("WPM: REJ. CMD: partner id mismatch")]
        if self._state == "taking":
            return [self._critical("WPM: REJ. CMD: Busy")]
        if self._state == "idle" or message.mission_type != self._type:
            self.notes.append(f"request for item {message.seq} by {sender} ignored: no download of it was begun")
            return []
        self._heard = now
        if message.seq == self._seq < self._count:
            self._seq += 1
        elif message.seq != self._seq - 1:
            self._state = "idle"
            why = f"item {message.seq} was asked for, and {self._seq} was due"
            refusal = self._no(sender, mavlink.MAV_MISSION_ERROR, self._type, why)
            return [refusal, self._critical("WPM: REJ. CMD: Req. WP was unexpected")]
        item = self._held[self._type][message.seq]
        current = self._type == MISSION and message.seq == self._pilot.current
        sent = item if self._as_int else plain(item)
        return [item_message(sent, message.seq, sender, self._type, current, self._as_int)]

    def _handle_ack(self, message: Message, sender: Ident, now: float) -> list[Message]:
        if sender != self._partner:
            return [self._critical("REJ. WP CMD: partner id mismatch")]
        if self._state == "giving" and message.mission_type == self._type:
            self._state = "idle"
        elif self._state == "taking" and message.type == mavlink.MAV_MISSION_UNSUPPORTED:
            self._as_int = not self._as_int
            return [self._ask(now)]
        elif self._state == "taking" and message.type == mavlink.MAV_MISSION_OPERATION_CANCELLED:
            self._state = "idle"
            self.notes.append(f"upload of {type_name(self._type)} cancelled by {sender} at item {self._seq}")
        return []

    def _handle_clear(self, message: Message, sender: Ident, now: float) -> list[Message]:
        if self._state != "idle":
            self.notes.append(f"clearing by {sender} ignored: busy with {self._partner}")
            return [self._critical("WPM: IGN CLEAR CMD: Busy")]
        wanted = message.mission_type
        if wanted not in (*self._held, _ALL_TYPES):
            return []
        for mission_type in self._held if wanted == _ALL_TYPES else (wanted,):
            self._held[mission_type] = []
        self.notes.append(f"{'everything' if wanted == _ALL_TYPES else type_name(wanted)} cleared by {sender}")
        return [acknowledge(sender, mavlink.MAV_MISSION_ACCEPTED, wanted)]

    def _handle_current(self, message: Message, sender: Ident, now: float) -> list[Message]:
        if self._state != "idle":
            return [self._critical("WPM: IGN WP CURR CMD: Busy")]
        if message.seq >= len(self._held[MISSION]) or not self._pilot.jump(message.seq):
            self.notes.append(f"item {message.seq} cannot be made the current one")
            return [self._critical("WPM: WP CURR CMD: Not in list")]
        self.notes.append(f"item {message.seq} is the current one")
        return [mavlink.MAVLink_mission_current_message(self._pilot.current)]

    def _ask(self, now: float) -> Message:
        self._sent = now
        make = mavlink.MAVLink_mission_request_int_message if self._as_int else mavlink.MAVLink_mission_request_message
        return make(self._partner.system, self._partner.component, self._seq, self._type)

    def _critical(self, words: str) -> Message:
        return text(mavlink.MAV_SEVERITY_CRITICAL, words)

    def _no(self, to: Ident, code: int, mission_type: int, why: str) -> Message:
        self.notes.append(f"refused {to} ({type_name(mission_type)}): {result_name(code)}, {why}")
        return acknowledge(to, code, mission_type)
