"""The same code on the CPU and on a GPU: on a real one where there is one, on a fake one everywhere."""

import pytest

from parser_service.neural.t5.t5_parser import T5
from parser_service.parsers.interface import Cancelled
from tests.parser_service.neural.conftest import StoppedOnce
from tests.parser_service.neural.fake_device import CPU, FAKE, computing_on
from tests.parser_service.neural.t5.conftest import TWENTY, parser_of
from tests.parser_service.neural.test_device import GPU, agree

pytestmark = [
    pytest.mark.usefixtures("kept_there"),
    pytest.mark.filterwarnings("ignore:for .* copying from a non-meta parameter"),
]
ASKED = [TWENTY[0].utterance, "☃"]


@pytest.mark.parametrize("device", [FAKE, GPU], ids=str)
@pytest.mark.parametrize("encoder", ["t5", "bart"])
def test_a_parser_trained_elsewhere_answers_alike_on_the_cpu(encoder, device, tmp_path):
    run = StoppedOnce(tmp_path / "run")
    with computing_on(device):
        parser = parser_of(encoder=encoder, decoding="listed", precision="fp32")
        with pytest.raises(Cancelled):
            parser.fit(TWENTY, (), run)
        parser.fit(TWENTY, (), run)
        assert {weights.device.type for weights in parser._network.model.parameters()} == {
            device.type
        }
        there = parser.predict(ASKED, 2)
        parser.save(tmp_path / "saved")
        assert T5.load(tmp_path / "saved").predict(ASKED, 2) == there
    with computing_on(CPU):
        assert agree(T5.load(tmp_path / "saved").predict(ASKED, 2), there)
