# SPDX-License-Identifier: Apache-2.0
import json

import cohort
import yaml


def of_example(name, **fields):
    """Returns the text of an experiment that comes with Cohort, with absolute paths and these fields."""
    file = cohort._files.experiment_called(name)
    experiment = yaml.safe_load(file.read_text())
    experiment["world"] = str((file.parent / experiment["world"]).resolve())
    return json.dumps(experiment | fields, indent=1)
