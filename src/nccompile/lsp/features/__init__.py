"""What an editor shows: functions of a document and its analysis, without protocol or state."""
