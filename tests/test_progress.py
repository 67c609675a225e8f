import threading

import pytest

from gcs_windplan.errors import CancelledError, WindplanError
from gcs_windplan.progress import CancelToken, Progress


def test_progress_says_what_is_done_and_how_much_of_it():
    assert str(Progress("laying the graph", 2, 5)) == "laying the graph: 2 of 5"
    assert str(Progress("searching", 3)) == "searching"


def test_a_token_is_quiet_until_another_thread_cancels_it():
    token = CancelToken()
    token.raise_if_cancelled()
    thread = threading.Thread(target=token.cancel)
    thread.start()
    thread.join()
    assert token.cancelled
    with pytest.raises(CancelledError, match="cancelled"):
        token.raise_if_cancelled()


def test_cancelled_work_is_one_of_the_errors_of_this_package():
    assert issubclass(CancelledError, WindplanError)
