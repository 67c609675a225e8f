from .mission import mission_of_document as mission_of_document
from .mission import read_mission as read_mission
from .parsing import MissionDocument as MissionDocument
from .parsing import parse_mission as parse_mission
from .parsing import read_document as read_document
