from .build import read_mission as read_mission
from .parsing import MissionDocument as MissionDocument
from .parsing import parse_mission as parse_mission
from .parsing import read_document as read_document
